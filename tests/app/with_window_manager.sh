#!/bin/sh
# Runs a program on a display that has a window manager, and ends with its exit code. Without one,
# nobody says which window has the keyboard.
#
#   xvfb-run -a with_window_manager.sh PROGRAM [ARGUMENT...]
set -eu
here=$(dirname "$0")
folder=$(mktemp -d)
mkfifo "$folder/said"
exec 3<>"$folder/said" # open on both sides: nobody waits for the other to open it
# Openbox says so itself when it manages the display; should it end before, that is said instead.
(openbox --sm-disable --config-file "$here/openbox.xml" --startup "sh -c 'echo ready >$folder/said'" \
  >"$folder/log" 2>&1 || echo failed >"$folder/said") &
read -r said <&3
if [ "$said" != ready ]; then
  cat "$folder/log" >&2
  rm -rf "$folder"
  exit 1
fi
code=0
"$@" || code=$?
openbox --exit >/dev/null 2>&1 || :
rm -rf "$folder"
exit "$code"
