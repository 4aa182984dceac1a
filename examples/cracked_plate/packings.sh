#!/bin/sh
# Fracture toughness from the peak load of plates with the same crack in other packings.
#   K_c = sigma_peak sqrt(pi a sec(pi a/W)), W = 40 mm, a = 10 mm, d = 0.5 mm
# The last cut and the first intact face lie up to d/2 apart on either side of the tip: K_c is known to 0.6 %.
# One row per run; arguments choose rows: hexagonal, square, random, random2, random5 (all).
# usage: PROGRAMS=build/release/bin examples/cracked_plate/packings.sh [rows ...]
set -eu
cd "$(dirname "$0")/../.."
programs=${PROGRAMS:-build/release/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# name, further settings
plate() {
  name=$1
  shift
  "$programs/ligament" run examples/cracked_plate/fast.json --output "$work/run" --json \
    --set '/specimen/size=["40 mm", "100 mm"]' --set '/time/duration=2.5 ms' \
    --set '/loads/0/velocity=[null, "3.3 mm/s"]' --set '/loads/1/velocity=[null, "-3.3 mm/s"]' \
    --set '/far_field={"cell_size": "2.07 mm", "levels": 1}' "$@" 2>/dev/null | tail -n 1 >"$work/json"
  rm -rf "$work/run"
  sed -n 's/.*"peak_load":\([0-9.e+-]*\).*/\1/p' "$work/json" | awk -v name="$name" '{
    pi = atan2(0, -1); w = 0.04; a = 0.01
    printf "%-24s K_c/K_Ic %.3f\n", name, $1 / w * sqrt(pi * a / cos(pi * a / w)) / 0.75e6 }'
}

turned() { # packing, degrees
  plate "$1 $2" --set "/discrete_zone/packing=\"$1\"" \
    --set "/discrete_zone/orientation=$(awk -v a="$2" 'BEGIN { print a * atan2(0, -1) / 180 }')"
}

random() { # size ratio
  for seed in 101 102 103 104 105 106 107 108 109 110; do
    plate "random, ratio $1, seed $seed" --set '/discrete_zone/packing="random"' \
      --set "/discrete_zone/seed=$seed" --set "/discrete_zone/size_ratio=$1"
  done
}

for row in ${*:-hexagonal square random random2 random5}; do
  case $row in
  hexagonal) for angle in 0 5 10 15 20 25 30; do turned hexagonal $angle; done ;;
  square) for angle in 0 15 30 45; do turned square $angle; done ;;
  random) random 1 ;;
  random2) random 2 ;;
  random5) random 5 ;;
  *) echo "no row \"$row\"" >&2 && exit 2 ;;
  esac
done
