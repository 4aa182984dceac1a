#!/bin/sh
# The events of a run of this scene beside beam theory with root correction (README.md):
#   usage: examples/double_cantilever/beam.sh FOLDER_OF_THE_RUN
# One row per load at which a face broke in equilibrium: opening, load, crack length, the load over that of
# beams of this length at this opening, K over K_Ic, the load over that of beams whose K is K_Ic at this
# opening; in the end what the crack took per area.
set -eu
awk -F, '
function beam(a,   b, inertia, neck) { # sets compliance, factor = K/P
  b = a + 0.6728 * h
  inertia = h * h * h / 12
  neck = w * w * w / 12
  moment = b * b / (2 * inertia) / (t / neck + b / inertia)
  compliance = 2 * (b * b * b / (3 * inertia) - moment * b * b / (2 * inertia) + t / w) / e
  factor = sqrt(12 / (h * h * h)) * (b - moment)
}
BEGIN {
  e = 72e9 / (1 - 0.22 * 0.22); toughness = 0.75e6
  d = 0.5e-3; h = 8e-3 - d / (4 * sqrt(3)); w = 1e-3; t = 4e-3; first = 32.5e-3 + d / 4
  print "opening/um  load/(N/m)   a/mm  load/beams  K/K_Ic  load/beams at K_Ic"
}
NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
NR > 2 {
  opening = $column["displacement"]; load = $column["load"]; broken = $column["broken_bonds"]
  # The row of the event has the face that broke in it already.
  if (broken == before + 1 && $column["static"] == 1) {
    a = first + before * d / 2
    beam(a)
    stiff = load * compliance / opening; k = load * factor / toughness
    low = 1e-3; high = 1
    for (i = 0; i < 60; ++i) {
      middle = (low + high) / 2
      beam(middle)
      if (toughness / factor * compliance < opening) low = middle; else high = middle
    }
    printf "%10.2f  %10.1f  %5.2f  %10.4f  %6.4f  %18.4f\n", opening * 1e6, load, a * 1e3, stiff, k, load / (toughness / factor)
  }
  before = broken
  taken = $column["external_work"] - $column["potential_discrete"] - $column["kinetic_discrete"]
}
END {
  printf "%d faces took %.4g J/m^2, G_c = (1 - nu^2) K_Ic^2/E = %.4g J/m^2\n", before, taken / (before * d / 2), toughness * toughness / e
}' "$1/history.csv"
