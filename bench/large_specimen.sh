#!/bin/sh
# A cracked plate of 1e7 equivalent particles, coupled, 10 000 steps on one core: wall time of the loop, against
# pure discrete elements, whose time for as many steps is extrapolated by particles from a strip of a tenth of
# the plate (1000 steps). One JSON line: value and reference in seconds, ratio = reference / value.
# usage: bench/large_specimen.sh [directory of the programs]
set -eu
cd "$(dirname "$0")/.."
programs=${1:-build/release/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { sed -n "s/.*\"$1\":\([-+0-9.e]*\).*/\1/p"; }

# height in mm, steps, further keys: the run's JSON, without pictures on the way
run() {
  height=$1 steps=$2
  shift 2
  set -- --set "/specimen/size=[\"800 mm\", \"$height mm\"]" \
    --set '/specimen/cracks=[{"points": [["-100 mm", 0], ["100 mm", 0]]}]' "$@"
  dt=$("$programs/ligament" check examples/cracked_plate/scene.json --json "$@" | tail -n 1 | field dt)
  duration=$(awk "BEGIN {print $dt * $steps}")
  "$programs/ligament" run examples/cracked_plate/scene.json --output "$work/run" --json "$@" \
    --set "/time/duration=$duration" --set /time/stop_when=end --set "/output/field_interval=1 s" \
    --set "/output/history_interval=1 s" 2>/dev/null | tail -n 1
  rm -rf "$work/run"
}

run 2706 10000 --set /far_field/levels=4 >"$work/coupled"
run 270.6 1000 --set /far_field=none >"$work/pure"
awk "BEGIN {
  coupled = $(field wall_seconds <"$work/coupled") / $(field steps <"$work/coupled") * 10000
  pure = $(field wall_seconds <"$work/pure") / $(field steps <"$work/pure") * 10000 * 10
  printf \"{\\\"name\\\": \\\"1e7 equivalent particles, 1e4 steps\\\", \\\"value\\\": %.1f, \\\"unit\\\": \\\"s\\\", \\\"reference\\\": %.0f, \\\"ratio\\\": %.1f}\\n\", coupled, pure, pure / coupled
  printf \"{\\\"name\\\": \\\"its set-up\\\", \\\"value\\\": %.1f, \\\"unit\\\": \\\"s\\\", \\\"reference\\\": null, \\\"ratio\\\": null}\\n\", $(field setup_seconds <"$work/coupled")
  printf \"{\\\"name\\\": \\\"its memory\\\", \\\"value\\\": %.0f, \\\"unit\\\": \\\"MiB\\\", \\\"reference\\\": null, \\\"ratio\\\": null}\\n\", $(field peak_memory_bytes <"$work/coupled") / 1048576
}"
