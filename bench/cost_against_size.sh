#!/bin/sh
# Seconds per step of the coupled run while the specimen grows from 1e5 to 1e7 equivalent particles around the same
# discrete zone (a box of 80 x 35.2 mm), and of pure discrete elements as far as 1e6. One JSON line per size: value =
# coupled, reference = pure discrete elements (1e7: by particles from 1e6). At last the slopes of the logarithms
# between the smallest and the largest size measured.
# usage: bench/cost_against_size.sh [directory of the programs]
set -eu
cd "$(dirname "$0")/.."
. bench/scene_runs.sh

# edge of the square in mm, steps, further keys: seconds per step
square() {
  edge=$1 steps=$2
  shift 2
  seconds_per_step "$steps" --set "/specimen/size=[\"$edge mm\", \"$edge mm\"]" "$@"
}

zone='/discrete_zone/region={"lower": ["-40 mm", "-17.6 mm"], "upper": ["40 mm", "17.6 mm"]}'
for size in "1e5 147 2 2000" "3e5 255 3 2000" "1e6 465 3 500" "3e6 806 3 0" "1e7 1471 3 0"; do
  set -- $size
  coupled=$(square "$2" 4000 --set "$zone" --set "/far_field/levels=$3" --set /coupling/step_ratio=3)
  cells=$(planned cells)
  [ "$1" != 1e5 ] || first=$coupled
  if [ "$4" -gt 0 ]; then
    pure=$(square "$2" "$4" --set /far_field=none)
    per_particle=$(awk "BEGIN {print $pure / $(planned particles)}")
    [ "$1" != 1e5 ] || first_pure=$pure
    last_pure=$pure
  fi
  json_line "$1 equivalent particles, $cells cells" "$coupled" s "$per_particle * $1" "$per_particle * $1 / $coupled"
done
json_line "slope of time against size" "log($coupled / $first) / log(100)" 1 "log($last_pure / $first_pure) / log(10)" \
  "(log($coupled / $first) / log(100)) / (log($last_pure / $first_pure) / log(10))"
