#!/bin/sh
# Which hole the crack reaches, where, and how the path goes there (README.md):
#   usage: examples/three_holes/path.sh FOLDER_OF_THE_RUN
set -eu
awk -F, '
BEGIN {
  split("bottom middle top", name, " "); height[1] = -31.75; height[2] = 19.05; height[3] = 69.85
  reach = 6.35 + 2 # mm: of the rim and a spacing
}
NR > 2 && !found {
  x = $4 * 1e3; y = $5 * 1e3; ++n
  if (y >= next_y || n == 1) { printf "%7.1f %7.1f\n", x, y; next_y = y + 5 }
  for (k = 1; k <= 3; ++k)
    if ((x + 101.6) ^ 2 + (y - height[k]) ^ 2 < reach ^ 2) {
      found = 1
      printf "reaches the %s hole at %.1f, %.1f mm with face %d\n", name[k], x, y, n
    }
}
END { if (!found) print "reaches no hole" }' "$1/broken_bonds.csv"
