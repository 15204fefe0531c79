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
side=-35:12
if [ -s "$models/armadillo.off" ]; then
  model=$models/armadillo.off
  side=200:12 # it turns its back to the default side
fi
draw="--view $side --least-bend-degrees 1 --vertex-radius 0"
bent=$out/model-bent.${model##*.}
step() { printf '\n\033[1m%s\033[0m\n' "$*"; }

step "The model: $(basename "$model")"
"$program" info "$model"

step "A cage to edit: the best of 100 vertices"
"$program" generate "$model" -o "$out/cage.obj" --json "$out/cage.json"

step "Is it valid? An independent check on the file"
"$program" check "$model" "$out/cage.obj"

step "A cage of boxes: how the model is put together"
"$program" generate "$model" -o "$out/box-cage.obj" --depth 5
"$program" generate "$model" -o "$out/boxes.obj" --depth 5 --emit boxes --quiet
"$program" check "$model" "$out/box-cage.obj"

step "Bending the cage bends the model"
python3 "$tools/pose.py" "$out/cage.obj" "$out/cage-bent.obj" --bend 50
"$program" deform "$model" "$out/cage.obj" "$out/cage-bent.obj" -o "$bent"

step "Pictures"
"$program" render "$model" $draw -o "$out/model.png"
"$program" render "$out/boxes.obj" $draw --color-by-group -o "$out/boxes.png"
"$program" render "$model" "$out/cage.obj" $draw -o "$out/cage.png"
"$program" render "$model" "$out/box-cage.obj" $draw -o "$out/box-cage.png"
"$program" render "$bent" "$out/cage-bent.obj" $draw -o "$out/bent.png"
ls "$out"/*.png
