#!/bin/sh
# Where and when the bar breaks first, beside one-dimensional theory (README.md):
#   usage: examples/spall/plane.sh FOLDER_OF_THE_RUN
set -eu
awk -F, '
BEGIN {
  c = sqrt(72e9 / 2450); length_of_bar = 0.16; pulse = 7.4e-6; delay = 4e-6; share = 30 / (2 * 20)
  plane = c * delay / 2
  meeting = (length_of_bar / c + delay) / 2
  moment = meeting + pulse / 3.14159265 * atan2(share, sqrt(1 - share * share))
}
NR > 2 && (n == 0 || $3 == first) { first = $3; sum += $4; ++n }
END {
  way = length_of_bar / 2 + plane
  printf "plane   %.3f mm, theory %.3f mm: %+.2f %% of the way of the first pulse, %+.1f %% of c T (%d faces)\n",
    sum / n * 1e3, plane * 1e3, (sum / n - plane) / way * 100, (sum / n - plane) / (c * pulse) * 100, n
  printf "time    %.3f us, theory %.3f us: %+.2f %%, %+.1f %% of the time since the pulses met\n",
    first * 1e6, moment * 1e6, (first / moment - 1) * 100, (first - moment) / (moment - meeting) * 100
}' "$1/broken_bonds.csv"
