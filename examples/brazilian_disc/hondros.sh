#!/bin/sh
# Stress along the loaded diameter at the end of runs of this scene without fracture (README.md), over that of Hondros for
# a radial pressure and over the exact one for a vertical pressure, which the scene has:
#   usage: examples/brazilian_disc/hondros.sh FOLDER_OF_THE_RUN..
# Gauges are boxes of 2 mm named y0, y4, .. by their height in mm; formulas are averaged over the same boxes.
set -eu
for run in "$@"; do
  echo "$run"
  awk -F, '
  function hondros(y, total,   r, u, v) { # y in m; sets sx, sy
    r = (y / R) ^ 2
    u = (1 - r) * sin(2 * A) / (1 - 2 * r * cos(2 * A) + r * r)
    v = (1 + r) / (1 - r) * sin(A) / cos(A); v = atan2(v, 1)
    sx = total / (R * A * PI) * (u - v); sy = -total / (R * A * PI) * (u + v)
  }
  function exact(x, y, total,   i, s, angle, dx, dy, rr) { # pairs of forces on chords along y (Timoshenko and Goodier)
    sx = 0; sy = 0
    for (i = 0; i < 200; ++i) {
      angle = A * ((2 * i + 1) / 200 - 1)
      for (s = -1; s <= 1; s += 2) {
        dx = x - R * sin(angle); dy = y - s * R * cos(angle); rr = dx * dx + dy * dy
        sx -= 2 / PI * sqrt(dy * dy) * dx * dx / (rr * rr); sy -= 2 / PI * sqrt(dy * dy) * dy * dy / (rr * rr)
      }
      sx += cos(angle) / (PI * R); sy += cos(angle) / (PI * R)
    }
    sx *= total / 200; sy *= total / 200
  }
  BEGIN { PI = 3.14159265358979; R = 0.025; A = atan2(3.263, sqrt(25 ^ 2 - 3.263 ^ 2)) }
  NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
  NR > 2 { last = $0 }
  END {
    split(last, row, ","); total = -row[column["load"]]
    print " y, mm   xx, MPa  over Hondros  over exact     yy, MPa  over Hondros  over exact"
    for (height = 0; height <= 16; height += 4) {
      hx = hy = ex = ey = 0
      for (i = 0; i < 6; ++i) {
        y = (height + (2 * i + 1) / 6 - 1) / 1e3
        hondros(y, total); hx += sx / 6; hy += sy / 6
        for (j = 0; j < 6; ++j) { exact(((2 * j + 1) / 6 - 1) / 1e3, y, total); ex += sx / 36; ey += sy / 36 }
      }
      xx = row[column["y" height "_xx"]]; yy = row[column["y" height "_yy"]]
      printf "%6d %9.3f %13.4f %11.4f %11.3f %13.4f %11.4f\n", height, xx / 1e6, xx / hx, xx / ex, yy / 1e6, yy / hy, yy / ey
    }
  }' "$run/history.csv"
done
