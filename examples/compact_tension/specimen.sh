#!/bin/sh
# A run of this scene beside the formulas for the compact tension specimen (README.md):
#   usage: examples/compact_tension/specimen.sh FOLDER_OF_THE_RUN [END_OF_THE_CRACK/mm]
# All figures are those of the equilibrium in which the first face breaks; a is 25.125 mm when not given.
set -eu
awk -F, -v a="${2:-25.125}" '
NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
NR > 2 && $column["pull_y"] > peak { peak = $column["pull_y"] }
NR > 2 && $column["broken_bonds"] > 0 && !found { # the row of the event has the face that broke in it already
  found = 1
  e = 72e9 / (1 - 0.22 * 0.22); toughness = 0.75e6
  w = 0.05; x = a * 1e-3 / w
  load = $column["pull_y"]
  # ASTM E399 (Srawley): K = P/W^0.5 f(a/W), per thickness.
  f = (2 + x) * (0.886 + 4.64 * x - 13.32 * x ^ 2 + 14.72 * x ^ 3 - 5.6 * x ^ 4) / (1 - x) ^ 1.5
  k = load / sqrt(w) * f
  # Saxena and Hudak: opening at the face of the specimen, W/4 before the load line.
  face = load / e * (1 + 0.25 / x) * ((1 + x) / (1 - x)) ^ 2 * (1.6137 + 12.678 * x - 14.231 * x ^ 2 - 16.61 * x ^ 3 + 35.05 * x ^ 4 - 14.494 * x ^ 5)
  # The inverse, which the standard prints for the same place: a/W from the compliance.
  u = 1 / (sqrt(e * $column["mouth"] / load) + 1)
  inverse = 1.001 - 4.6695 * u + 18.46 * u ^ 2 - 236.82 * u ^ 3 + 1214.9 * u ^ 4 - 2143.6 * u ^ 5
  printf "load at the first broken face         %9.1f N\n", load
  printf "K of this load over K_Ic              %9.4f\n", k / toughness
  if ("tip_k" in column) printf "K of the gauge over K of the load     %9.4f\n", $column["tip_k"] / k
  if ("tip_j" in column) printf "J of the gauge over K^2/E\047 of the load%9.4f\n", $column["tip_j"] / (k * k / e)
  printf "opening of the mouth                  %9.4f um, over Saxena and Hudak %.4f\n", $column["mouth"] * 1e6, $column["mouth"] / face
  printf "a from this opening                   %9.3f mm\n", inverse * w * 1e3
}
END { printf "largest load                          %9.1f N\n", peak }' "$1/history.csv"
