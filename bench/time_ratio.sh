#!/bin/sh
# Time of pure discrete elements over time of the coupled run, against the ratio of their particle
# numbers: the cracked plate at three heights, the discrete zone the same. One JSON line per height:
# value = time ratio (median of three pairs), reference = particle ratio. Without output on the way: a row of the
# history reads all energies, which a short run must not do in every step.
# usage: bench/time_ratio.sh [directory of the programs]
set -eu
cd "$(dirname "$0")/.."
programs=${1:-build/release/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { sed -n "s/.*\"$1\":\([-+0-9.e]*\).*/\1/p"; }

# height, kind (keys that follow): seconds per step of the time loop, without set-up
seconds_per_step() {
  height=$1
  shift
  "$programs/ligament" run examples/cracked_plate/scene.json --output "$work/run" --json \
    --set "/specimen/size=[\"80 mm\", \"$height mm\"]" --set "/time/duration=0.1 ms" \
    --set /time/stop_when=end --set "/output/field_interval=1 s" --set "/output/history_interval=1 s" "$@" 2>/dev/null | tail -n 1 >"$work/json"
  rm -rf "$work/run"
  awk "BEGIN {print $(field wall_seconds <"$work/json") / $(field steps <"$work/json")}"
}

particles() {
  height=$1
  shift
  "$programs/ligament" check examples/cracked_plate/scene.json --json \
    --set "/specimen/size=[\"80 mm\", \"$height mm\"]" "$@" | tail -n 1 | field particles
}

for height in 200 400 800; do
  : >"$work/ratios"
  for repeat in 1 2 3; do
    coupled=$(seconds_per_step $height)
    pure=$(seconds_per_step $height --set /far_field=none)
    awk "BEGIN {print $pure / $coupled}" >>"$work/ratios"
  done
  time_ratio=$(sort -g "$work/ratios" | sed -n 2p)
  particle_ratio=$(awk "BEGIN {print $(particles $height --set /far_field=none) / $(particles $height)}")
  awk "BEGIN {printf \"{\\\"name\\\": \\\"time ratio, plate of $height mm\\\", \\\"value\\\": %.2f, \\\"unit\\\": \\\"1\\\", \\\"reference\\\": %.2f, \\\"ratio\\\": %.2f}\\n\", \
    $time_ratio, $particle_ratio, $time_ratio / $particle_ratio}"
done
