#!/bin/sh
# A cracked plate of 1e7 equivalent particles, coupled, 10 000 steps on one core: wall time of the loop, against
# pure discrete elements, whose time for as many steps is extrapolated by particles from a strip of a tenth of
# the plate (1000 steps). JSON lines: value and reference in seconds, ratio = reference / value.
# usage: bench/large_specimen.sh [directory of the programs]
set -eu
cd "$(dirname "$0")/.."
. bench/scene_runs.sh

# height in mm, steps, further keys: seconds per step
plate() {
  height=$1 steps=$2
  shift 2
  seconds_per_step "$steps" --set "/specimen/size=[\"800 mm\", \"$height mm\"]" \
    --set '/specimen/cracks=[{"points": [["-100 mm", 0], ["100 mm", 0]]}]' "$@"
}

coupled=$(plate 2706 10000 --set /far_field/levels=4)
setup=$(last setup_seconds) memory=$(last peak_memory_bytes)
pure=$(plate 270.6 1000 --set /far_field=none)
json_line "1e7 equivalent particles, 1e4 steps" "$coupled * 1e4" s "$pure * 1e5" "$pure * 10 / $coupled"
json_line "its set-up" "$setup" s "$coupled * 1e4" "$coupled * 1e4 / $setup"
json_line "its memory" "$memory / 1048576" MiB "$memory / 1048576" 1
