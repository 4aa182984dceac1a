# What the benches of whole runs share, read by them with `.` after `cd` to the project's root; $1 is the
# directory of the programs. All runs are variants of the cracked plate.
programs=${1:-build/release/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scene=examples/cracked_plate/fast.json

# key: its number in the JSON object on the standard input
field() { sed -n "s/.*\"$1\":\([-+0-9.e]*\).*/\1/p"; }

# an expression: its value
number() { awk "BEGIN {printf \"%.4g\", $1}"; }

# name, value, unit, reference, ratio: one line; numbers may be expressions
json_line() {
  printf '{"name": "%s", "value": %s, "unit": "%s", "reference": %s, "ratio": %s}\n' \
    "$1" "$(number "$2")" "$3" "$(number "$4")" "$(number "$5")"
}

# file, command: keeps the last line of what it says; where it fails, says why and stops
last_line_of() {
  file=$1
  shift
  "$@" >"$work/said" 2>"$work/errors" || { cat "$work/errors" >&2; exit 4; }
  tail -n 1 "$work/said" >"$work/$file"
}

# steps (keys that follow): runs that many steps and prints the seconds of one, set-up left out. Without output on
# the way: a row of the history reads all energies, which a short run must not do in every step.
seconds_per_step() {
  steps=$1
  shift
  last_line_of check "$programs/ligament" check $scene --json "$@"
  last_line_of json "$programs/ligament" run $scene --output "$work/run" --json "$@" \
    --set "/time/duration=$(awk "BEGIN {print $(planned dt) * $steps}")" --set /time/stop_when=end \
    --set "/output/field_interval=1 s" --set "/output/history_interval=1 s"
  rm -rf "$work/run"
  awk "BEGIN {print $(field wall_seconds <"$work/json") / $(field steps <"$work/json")}"
}

# key: its number in what the last run said at its end, and in what `check` said before
last() { field "$1" <"$work/json"; }
planned() { field "$1" <"$work/check"; }

# the middle one of three numbers, one to a line
median_of_three() { sort -g | sed -n 2p; }
