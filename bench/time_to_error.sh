#!/bin/sh
# Time to a given error of the peak load: the main example, coupled, against pure discrete elements at the same and
# at larger spacings. One JSON line per run: value = its time (start-up, set-up and output included), reference =
# that of pure discrete elements at the same spacing; its errors against them and against K_Ic in the name. Last line:
# pure discrete elements as coarse as the coupled run's error allows, their error taken to grow with the spacing as
# between the two finest of them, their time with its inverse cube, against the coupled run.
# usage: bench/time_to_error.sh [directory of the programs]
set -eu
cd "$(dirname "$0")/.."
programs=${1:-build/release/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs/ligament" sweep bench/time_to_error.json --output "$work/sweep" >&2
awk -F, '
  { gsub(/"([^"]|"")*"/, "quoted") }
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i }
  NR <= 2 { next }
  $3 != "done" { print "error: " $1 ": " $3 > "/dev/stderr"; exit 1 }
  { name[++n] = $1; time[$1] = $column["run_time"]; error[$1] = $column["peak_load_error"]; total[$1] = $column["total_peak_load_error"] }
  function size(x) { return x < 0 ? -x : x }
  function line(what, value, reference) {
    printf "{\"name\": \"%s\", \"value\": %.4g, \"unit\": \"s\", \"reference\": %.4g, \"ratio\": %.4g}\n", what, value, reference, reference / value
  }
  END {
    pure = time["pure DEM"]
    for (i = 1; i <= n; ++i)
      line(sprintf("%s, %+.2f %% of pure DEM, %+.2f %% of K_Ic", name[i], 100 * error[name[i]], 100 * total[name[i]]), time[name[i]], pure)
    coarser = size(error["pure DEM at 0.625 mm"])
    spacing = 1 + 0.25 * size(error["coupled"]) / coarser
    line(sprintf("pure DEM at %.3f mm, %.2f %% of pure DEM, interpolated; reference: coupled", 0.5 * spacing, 100 * size(error["coupled"])), pure / spacing ^ 3, time["coupled"])
  }' "$work/sweep/sweep.csv"
