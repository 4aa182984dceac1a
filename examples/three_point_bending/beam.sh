#!/bin/sh
# A run of this scene beside the formulas for beams in three-point bending (README.md):
#   usage: examples/three_point_bending/beam.sh FOLDER_OF_THE_RUN FOLDER_OF_THE_RUN_WITHOUT_CRACK [END_OF_THE_CRACK/mm]
# All figures are those of the equilibrium in which the first face breaks. The run without crack gives what the
# beam and the places of load and supports yield by themselves; a is 16.125 mm when not given.
set -eu
a=${3:-16.125}
compliance=$(awk -F, '
NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
NR > 2 && -$column["load"] > 1000 { print $column["deflection"] / -$column["load"]; exit }' "$2/history.csv")
axis=$(awk -F, '
NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
NR > 2 && -$column["load"] > 1000 { print $column["axis"] / -$column["load"]; exit }' "$2/history.csv")
awk -F, -v whole="$compliance" -v axis="$axis" -v a="$a" '
function factor(x) { # ASTM E1820: K = P S/W^1.5 f(a/W)
  return 3 * sqrt(x) * (1.99 - x * (1 - x) * (2.15 - 3.93 * x + 2.7 * x * x)) / (2 * (1 + 2 * x) * (1 - x) ^ 1.5)
}
NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
NR > 2 && $column["broken_bonds"] > 0 { # the row of the event has the face that broke in it already
  e = 72e9 / (1 - 0.22 * 0.22); toughness = 0.75e6
  w = 0.04; s = 0.16; x = a * 1e-3 / w
  load = -$column["load"]; stress = 1.5 * load * s / (w * w)
  f = factor(x)
  k = load * s / w ^ 1.5 * f
  v1 = 0.76 - 2.28 * x + 3.87 * x ^ 2 - 2.04 * x ^ 3 + 0.66 / (1 - x) ^ 2
  mouth = 4 * stress * a * 1e-3 / e * v1
  # What K releases while the crack grows to a (Irwin and Kies): 2 (S/W)^2/E times the integral of f^2.
  sum = 0
  for (i = 0; i < 1000; ++i) sum += factor((i + 0.5) * x / 1000) ^ 2 * x / 1000
  crack = 2 * load / e * (s / w) ^ 2 * sum
  # Timoshenko and Goodier, Theory of Elasticity, for a force at the middle and nu = 0.3.
  beam = load * s ^ 3 / (4 * e * w ^ 3) * (1 + 2.85 * (w / s) ^ 2 - 0.84 * (w / s) ^ 3)
  astm = load / e * (s / (w * (1 - x))) ^ 2 * (1.193 - 1.98 * x + 4.478 * x ^ 2 - 4.443 * x ^ 3 + 1.739 * x ^ 4)
  moved = $column["deflection"]
  printf "load at the first broken face            %9.1f N\n", load
  printf "K of this load over K_Ic                 %9.4f\n", k / toughness
  printf "K of the gauge over K of the load        %9.4f\n", $column["tip_k"] / k
  printf "J of the gauge over K^2/E\047 of the load   %9.4f\n", $column["tip_j"] / (k * k / e)
  printf "mouth opening                            %9.4f um, over Tada %.4f\n", $column["mouth"] * 1e6, $column["mouth"] / mouth
  printf "deflection by the crack                  %9.4f um, over that of the energy %.4f\n", (moved - load * whole) * 1e6, (moved - load * whole) / crack
  printf "of the axis without crack, this load     %9.4f um, over the beam %.4f\n", load * axis * 1e6, load * axis / beam
  printf "deflection in all                        %9.4f um, over ASTM %.4f\n", moved * 1e6, moved / astm
  less = moved - load * (whole - axis)
  printf "less what the contacts yield             %9.4f um, over ASTM %.4f\n", less * 1e6, less / astm
  exit
}' "$1/history.csv"
