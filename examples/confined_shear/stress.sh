#!/bin/sh
# Stresses of a run over those of theory, when the confinement is there, half-way through the shear and at the end.
# Usage: stress.sh FOLDER
set -eu
awk -F, '
  NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k; next }
  NR == 2 { next } # units
  {
    t = $column["time"]
    for (k = 1; k <= 3; ++k) {
      at = k == 1 ? 0.0095 : k == 2 ? 0.014 : 0.020
      away = t > at ? t - at : at - t
      if (!(k in least) || away < least[k]) { least[k] = away; row[k] = $0 }
    }
  }
  END {
    nu = 0.2; E = 20e9; p = 5e6
    printf "%8s %16s %16s %16s %16s\n", "time, ms", "theory yy, MPa", "press/area", "middle yy", "middle xx / -p"
    for (k = 1; k <= 3; ++k) {
      split(row[k], v, ",")
      t = v[column["time"]]
      way = t < 0.010 ? 0 : t > 0.018 ? 40e-6 : 40e-6 * (t - 0.010) / 0.008
      yy = -p * nu / (1 - nu) - E / (1 - nu * nu) * way / 0.16
      printf "%8.3f %16.5f %16.6f %16.6f %16.6f\n", 1e3 * t, yy / 1e6, v[column["press_y"]] / 0.08 / yy, v[column["middle_yy"]] / yy, -v[column["middle_xx"]] / p
    }
  }' "$1/history.csv"
