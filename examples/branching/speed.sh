#!/bin/sh
# How fast the crack runs, beside the Rayleigh speed (README.md): usage: examples/branching/speed.sh FOLDER..
# When it starts and when it arrives 45 mm away, its mean speed in between, the largest one over 4 us; how much
# longer than a straight crack all broken faces are, and how many ways cross the lines 20, 30 and 40 mm away
# from the notch: groups of faces within a millimetre of it that lie at least a millimetre apart.
set -eu
for run in "$@"; do
  awk -F, -v run="$run" '
  NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
  NR > 2 {
    place = $column["crack_position"]
    if (place > 1e-3 && !started) { started = $1; from = place }
    if (place > 45e-3 && !arrived) { arrived = $1; to = place }
    if ($column["crack_speed"] > fastest) fastest = $column["crack_speed"]
    cracked = $column["crack_length"]
  }
  END {
    rayleigh = 0.9110 * sqrt(32e9 / 2 / 1.2 / 2450)
    printf "%s: starts %.1f us, arrives %.1f us", run, started * 1e6, arrived * 1e6
    if (arrived) printf ", mean %.0f m/s = %.2f c_R", (to - from) / (arrived - started), (to - from) / (arrived - started) / rayleigh
    printf ", largest %.0f m/s = %.2f c_R, faces %.0f mm", fastest, fastest / rayleigh, cracked * 1e3
  }' "$run/history.csv"
  for place in 20 30 40; do
    tail -n +3 "$run/broken_bonds.csv" | awk -F, -v x="$place" '$4 * 1e3 > x - 1 && $4 * 1e3 < x + 1 { print $5 * 1e3 }' | sort -g |
      awk -v x="$place" 'NR == 1 || $1 - last > 1 { ++n } { last = $1 } END { printf ", %d at %d mm", n, x }'
  done
  echo
done
