# What the benches of whole runs share, read by them with `.` after `cd` to the project's root; $1 is the
# directory of the programs. All runs are variants of the cracked plate.
programs=${1:-build/release/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scene=examples/cracked_plate/scene.json

# key: its number in the JSON object on the standard input
field() { sed -n "s/.*\"$1\":\([-+0-9.e]*\).*/\1/p"; }

# name, value, unit, reference, ratio: one line; numbers may be expressions
json_line() {
  awk "BEGIN {printf \"{\\\"name\\\": \\\"$1\\\", \\\"value\\\": %.4g, \\\"unit\\\": \\\"$3\\\", \\\"reference\\\": %.4g, \\\"ratio\\\": %.4g}\n\", $2, $4, $5}"
}

# steps (keys that follow): runs that many steps and prints the seconds of one, set-up left out. Without output on
# the way: a row of the history reads all energies, which a short run must not do in every step.
seconds_per_step() {
  steps=$1
  shift
  "$programs/ligament" check $scene --json "$@" | tail -n 1 >"$work/check"
  "$programs/ligament" run $scene --output "$work/run" --json "$@" \
    --set "/time/duration=$(awk "BEGIN {print $(planned dt) * $steps}")" --set /time/stop_when=end \
    --set "/output/field_interval=1 s" --set "/output/history_interval=1 s" 2>/dev/null | tail -n 1 >"$work/json"
  rm -rf "$work/run"
  awk "BEGIN {print $(field wall_seconds <"$work/json") / $(field steps <"$work/json")}"
}

# key: its number in what the last run said at its end, and in what `check` said before
last() { field "$1" <"$work/json"; }
planned() { field "$1" <"$work/check"; }

# the middle one of three numbers, one to a line
median_of_three() { sort -g | sed -n 2p; }
