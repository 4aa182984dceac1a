#!/bin/sh
# Nominal strengths of beams beside Bazant's law of size effect (README.md): usage: size_law.sh FOLDER..
# For each run the depth W, the largest load P and sigma_N = P/(b W) with the thickness b; then W_0 and B f_t of
# sigma_N = B f_t/sqrt(1 + W/W_0), by the straight line of 1/sigma_N^2 over W, and how far off it each run lies.
set -eu
for run in "$@"; do
  awk -v run="$run" '
  /"size"/ { at = NR }
  at && NR == at + 2 { depth = $1 + 0 }
  /"thickness"/ { split($0, part, /[:,]/); thickness = part[2] + 0 }
  /"largest_load"/ { split($0, part, /[:,]/); peak = part[2] + 0 }
  END { if (peak < 0) peak = -peak; print run, depth, peak, peak / depth / thickness }' "$run/run.json"
done | awk '{
  name[NR] = $1; depth[NR] = $2; peak[NR] = $3; nominal[NR] = $4
  y = 1 / $4 ^ 2; n += 1; sx += $2; sy += y; sxx += $2 ^ 2; sxy += $2 * y
}
END {
  if (n > 2) { slope = (n * sxy - sx * sy) / (n * sxx - sx ^ 2); foot = (sy - slope * sx) / n }
  for (k = 1; k <= NR; ++k) {
    printf "%s  W %.0f mm  P %.0f N  sigma_N %.4f MPa", name[k], depth[k] * 1e3, peak[k], nominal[k] / 1e6
    if (n > 2) printf "  %+.2f %% off the law", (nominal[k] * sqrt(foot + slope * depth[k]) - 1) * 100
    printf "\n"
  }
  if (n > 2) printf "W_0 %.0f mm  B f_t %.3f MPa\n", foot / slope * 1e3, 1 / sqrt(foot) / 1e6
}'
