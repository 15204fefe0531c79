#!/usr/bin/env bash
# Makes a cage for a real model, deforms the model with it, and draws each step.
#   demo.sh PROGRAM MODELS_FOLDER_OR_EMPTY OUTPUT_FOLDER
set -euo pipefail
program=$1
models=$2
out=$3
tools=$(dirname "${BASH_SOURCE[0]}")
mkdir -p "$out"

model=$tools/../samples/creature.obj
if [ -n "$models" ]; then
  model=$models/armadillo.off
fi
step() { printf '\n\033[1m%s\033[0m\n' "$*"; }

step "The model: $(basename "$model")"
"$program" info "$model"

step "A cage of boxes"
"$program" generate "$model" -o "$out/cage.obj" --depth 5 --json "$out/cage.json"
"$program" generate "$model" -o "$out/boxes.obj" --depth 5 --emit boxes --quiet

step "Is it valid? An independent check on the file"
"$program" check "$model" "$out/cage.obj"

step "Bending the cage bends the model"
python3 "$tools/pose.py" "$out/cage.obj" "$out/cage-bent.obj" --bend 50
"$program" deform "$model" "$out/cage.obj" "$out/cage-bent.obj" -o "$out/model-bent.obj"

step "Pictures"
"$program" render "$model" "$out/cage.obj" -o "$out/cage.png"
"$program" render "$out/boxes.obj" --color-by-group -o "$out/boxes.png"
"$program" render "$out/model-bent.obj" "$out/cage-bent.obj" -o "$out/bent.png"
ls "$out"/*.png
