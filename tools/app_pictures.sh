#!/usr/bin/env bash
# Makes the pictures of the window for README and docs/app.md, as a person would come to see it: with real
# keys and a real mouse on a display of its own.
#
#   app_pictures.sh build/release/app/cagewright-app [FOLDER]
#
# Needs Xvfb, openbox, xdotool and ImageMagick.
set -euo pipefail
program=$(realpath "$1")
tools=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
images=$(realpath "${2:-$tools/../docs/images}")
model=$(realpath "$tools/../samples/creature.obj")
cage=$(realpath "$tools/../app/samples/creature-cage.obj")
width=1440
height=900

work=$(mktemp -d)
processes=()
finish() {
  for process in "${processes[@]}"; do kill "$process" 2>/dev/null || :; done
  wait 2>/dev/null || :
  rm -rf "$work"
}
trap finish EXIT

mkfifo "$work/display"
exec 3<>"$work/display"
Xvfb -displayfd 3 -screen 0 ${width}x${height}x24 >/dev/null 2>&1 &
processes+=($!)
read -r display <&3
export DISPLAY=:$display QT_QPA_PLATFORM=xcb LIBGL_ALWAYS_SOFTWARE=1
openbox --sm-disable >/dev/null 2>&1 &
processes+=($!)

picture() { import -window root "$1"; }
# Until nothing changes any more: jobs are done, the picture is as fine as it gets.
settle() {
  local same=0
  picture "$work/before.png"
  while [ $same -lt 3 ]; do
    sleep 0.4
    picture "$work/now.png"
    if compare -metric AE "$work/before.png" "$work/now.png" null: 2>/dev/null; then
      same=$((same + 1))
    else
      same=0
    fi
    mv "$work/now.png" "$work/before.png"
  done
}
keys() { for key in "$@"; do xdotool key "$key"; sleep 0.1; done; settle; }
click() { xdotool mousemove "$1" "$2"; sleep 0.2; xdotool click "${3:-1}"; settle; }
command() { xdotool key F3; settle; xdotool type "$1"; settle; keys Return; }
drag() { # X1 Y1 X2 Y2
  xdotool mousemove "$1" "$2"; sleep 0.2
  xdotool mousedown 1; sleep 0.1
  local i
  for i in 1 2 3 4 5 6 7 8; do
    xdotool mousemove $(($1 + ($3 - $1) * i / 8)) $(($2 + ($4 - $2) * i / 8)); sleep 0.05
  done
  xdotool mouseup 1
  settle
}
# Runs the program as at its first start: start light|dark [ARGUMENT...]
start() {
  local colors=$1
  shift
  local home=$work/home-$RANDOM
  mkdir -p "$home/.config/Cagewright" "$home/run"
  chmod 700 "$home/run"
  printf '[General]\ntheme=%s\nask_before_closing=false\n' "$colors" >"$home/.config/Cagewright/Cagewright.conf"
  HOME=$home XDG_CONFIG_HOME=$home/.config XDG_DATA_HOME=$home XDG_RUNTIME_DIR=$home/run "$program" "$@" &
  running=$!
  processes+=("$running")
  until xdotool search --onlyvisible --pid $running >/dev/null 2>&1; do sleep 0.2; done
  xdotool mousemove $((width / 2)) $((height - 160))
  settle
}
stop() { kill $running; wait $running 2>/dev/null || :; }
keep() { xdotool mousemove $((width / 2)) 5; settle; picture "$images/$1"; }

# A model in its cage.
start light "$model"
keys ctrl+g
keep app-cage.png
stop

# Poses and keyframes.
start dark "$model" "$cage"
keys ctrl+b
keys k            # the time line unfolds
command "see through"
keys b
drag 470 160 930 430 # the head
click 700 815     # a later frame
keys r 1 8 Return
keys k ctrl+k
click 1252 858    # the panel Poses
keep app-posed.png
stop

# At work: the model itself is dragged.
start light "$model" "$cage"
keys ctrl+b
click 428 61      # the tool Drag Model
click 700 560     # a pin that holds
drag 757 300 880 230
click 1304 858    # the panel History
keep app-work.png
stop
