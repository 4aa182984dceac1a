#!/bin/sh
# Time of pure discrete elements over time of the coupled run, against the ratio of their particle numbers: the
# cracked plate at three heights, the discrete zone the same; and a wide one whose zone has 160 000 particles, 14 % of
# them in the overlap. One JSON line per plate: value = time ratio (median of three pairs), reference = particle ratio.
# usage: bench/time_ratio.sh [directory of the programs]
set -eu
cd "$(dirname "$0")/.."
. bench/scene_runs.sh

# width and height in mm, half height of the zone in mm, steps
plate() {
  set -- "$1" "$2" "$4" --set "/specimen/size=[\"$1 mm\", \"$2 mm\"]" \
    --set "/discrete_zone/region={\"lower\": [null, \"-$3 mm\"], \"upper\": [null, \"$3 mm\"]}"
  name="time ratio, plate of $1 x $2 mm" steps=$3
  shift 3
  : >"$work/ratios"
  for repeat in 1 2 3; do
    coupled=$(seconds_per_step "$steps" "$@")
    particles=$(planned particles) overlap=$(planned overlap_particles)
    pure=$(seconds_per_step "$steps" "$@" --set /far_field=none)
    awk "BEGIN {print $pure / $coupled}" >>"$work/ratios"
  done
  time_ratio=$(median_of_three <"$work/ratios")
  particle_ratio=$(awk "BEGIN {print $(planned particles) / $particles}")
  share=$(awk "BEGIN {printf \"%.0f\", 100 * $overlap / $particles}")
  json_line "$name, $particles particles, $share % in the overlap" "$time_ratio" 1 "$particle_ratio" "$time_ratio / $particle_ratio"
}

for height in 200 400 800; do
  plate 80 $height 17.6 4000
done
for height in 400 800; do
  plate 400 $height 44 1000
done
