#!/bin/sh
# The angle of the crack against the notch (README.md): usage: examples/kalthoff/angle.sh FOLDER..
# For each run the angle of the line from the notch's upper corner to the first broken face that is 10, 20, 30,
# 40 mm away from it, and when that face broke. Only faces count that a chain of faces broken before, with gaps
# of 2 mm at most, joins to the corner. In the end means, and the standard deviation of one run.
set -eu
for run in "$@"; do
  tail -n +3 "$run/broken_bonds.csv" | sort -t, -k3,3g | awk -F, -v run="$run" '
  BEGIN { n = 1; px[0] = 0; py[0] = -0.02425; next_one = 1 }
  {
    joined = 0
    for (i = n - 1; i >= 0 && !joined; --i) joined = ($4 - px[i]) ^ 2 + ($5 - py[i]) ^ 2 < 4e-6
    if (!joined) next
    px[n] = $4; py[n] = $5; ++n
    for (; next_one <= 4 && $4 ^ 2 + ($5 + 0.02425) ^ 2 >= (next_one * 0.01) ^ 2; ++next_one) {
      angle[next_one] = atan2($5 + 0.02425, $4) * 180 / 3.14159265; time[next_one] = $3 * 1e6
    }
  }
  END {
    printf "%s", run
    for (k = 1; k < next_one; ++k) printf "  %.1f deg (%.1f us)", angle[k], time[k]
    printf "\n"
  }'
done | awk '{ print; for (k = 2; k + 3 <= NF; k += 4) { sum[k] += $k; square[k] += $k * $k; ++n[k] } }
END {
  printf "mean"
  for (k = 2; k in n; k += 4) {
    m = sum[k] / n[k]
    printf "  %.1f +- %.1f deg", m, (n[k] > 1 ? sqrt((square[k] - n[k] * m * m) / (n[k] - 1)) : 0)
  }
  printf "\n"
}'
