#!/bin/sh
# What `ligament check` predicts against the run itself, for examples that go by steps: time of the whole run
# (per step, output and set-up, scaled to the steps that the run took before it broke) and memory. One
# JSON line per figure: value = predicted, reference = measured.
# usage: bench/check_prediction.sh [directory of the programs] [keys of all runs, such as --set ...]
set -eu
cd "$(dirname "$0")/.."
programs=${1:-build/release/bin}
[ $# -gt 0 ] && shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { sed -n "s/.*\"$1\":\([-+0-9.e]*\).*/\1/p" "$work/$2"; }

line() {
  awk "BEGIN {printf \"{\\\"name\\\": \\\"$1\\\", \\\"value\\\": %.4g, \\\"unit\\\": \\\"$2\\\", \\\"reference\\\": %.4g, \\\"ratio\\\": %.3f}\n\", $3, $4, ($3) / ($4)}"
}

for example in cracked_plate/fast plate_with_hole/scene closed_crack/scene; do
  scene=examples/$example.json
  "$programs/ligament" check $scene --json "$@" 2>/dev/null | tail -n 1 >"$work/check"
  "$programs/ligament" run $scene --output "$work/run" --json "$@" 2>/dev/null | tail -n 1 >"$work/json"
  rm -rf "$work/run"
  line "time, $example" s \
    "$(field setup_seconds check) + $(field steps json) * ($(field seconds_per_step check) +
      $(field output_seconds check) / $(field steps check))" \
    "$(field setup_seconds json) + $(field wall_seconds json)"
  line "memory, $example" B "$(field memory_bytes check)" "$(field peak_memory_bytes json)"
done
