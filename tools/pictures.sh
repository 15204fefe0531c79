#!/usr/bin/env bash
# Makes the pictures of README and docs from the bundled sample:  pictures.sh PROGRAM [FOLDER]
set -euo pipefail
program=$1
tools=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
images=${2:-$tools/../docs/images}
model=$tools/../samples/creature.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$images"

draw() { "$program" render "$@" --size 560x560 --least-bend-degrees 1 --vertex-radius 0 --edge-width 1.6; }
generate() { "$program" generate "$model" --quiet "$@"; }

# A strip: the model, a cage of 120 vertices from two sides, the model bent by the cage.
generate --vertices 120 -o "$work/cage.obj"
python3 "$tools/pose.py" "$work/cage.obj" "$work/posed.obj" --bend 50
"$program" deform "$model" "$work/cage.obj" "$work/posed.obj" -o "$work/posed_model.obj" --quiet
draw_edited() { "$program" render "$@" --size 560x560 --vertex-radius 2.6 --edge-width 1.8; }
draw_edited "$model" -o "$work/1.png" --view -35:12
draw_edited "$model" "$work/cage.obj" --view -35:12 --beside "$work/1.png" -o "$work/2.png"
draw_edited "$model" "$work/cage.obj" --view 145:12 --beside "$work/2.png" -o "$work/3.png"
draw_edited "$work/posed_model.obj" "$work/posed.obj" --view -35:12 --beside "$work/3.png" -o "$images/overview.png"

# The stages: voxels, and boxes at growing depth.
generate --resolution 48 --emit voxels -o "$work/voxels.obj"
draw "$work/voxels.obj" --color-by-group --view -35:12 -o "$work/stages.png"
for depth in 0 1 3 5; do
  generate --depth "$depth" --emit boxes -o "$work/boxes.obj"
  draw "$work/boxes.obj" --color-by-group --view -35:12 --beside "$work/stages.png" -o "$work/next.png"
  mv "$work/next.png" "$work/stages.png"
done
generate --depth 5 -o "$work/cage.obj"
draw "$model" "$work/cage.obj" --view -35:12 --beside "$work/stages.png" -o "$images/stages.png"

# Budgets: 50, 100, 200 and 400 vertices.
for vertices in 50 100 200 400; do
  generate --vertices "$vertices" -o "$work/cage.obj"
  beside=()
  [ "$vertices" = 50 ] || beside=(--beside "$work/budget.png")
  draw_edited "$model" "$work/cage.obj" --view -35:12 "${beside[@]}" -o "$work/next.png"
  mv "$work/next.png" "$work/budget.png"
done
mv "$work/budget.png" "$images/budget.png"

# Symmetry: the same budget without and with it, from the front, and from the side.
generate --vertices 100 --symmetry off -o "$work/off.obj"
generate --vertices 100 --symmetry auto -o "$work/cage.obj"
draw_edited "$model" "$work/off.obj" --view 0:8 -o "$work/1.png"
draw_edited "$model" "$work/cage.obj" --view 0:8 --beside "$work/1.png" -o "$work/2.png"
draw_edited "$model" "$work/cage.obj" --view -35:12 --beside "$work/2.png" -o "$images/symmetry.png"

# Quads: 60, 120 and 240 vertices.
for vertices in 60 120 240; do
  generate --vertices "$vertices" --quads -o "$work/cage.obj"
  beside=()
  [ "$vertices" = 60 ] || beside=(--beside "$work/quads.png")
  draw_edited "$model" "$work/cage.obj" --view -35:12 "${beside[@]}" -o "$work/next.png"
  mv "$work/next.png" "$work/quads.png"
done
mv "$work/quads.png" "$images/quads.png"
