#!/bin/sh
# Fracture toughness from the peak load of plates with the same crack and finer and finer particles.
#   K_c = sigma_peak sqrt(pi a sec(pi a/W))
# W = 40 mm; half crack length a = 10 mm + d/4: faces cross the crack line every d/2 and the last one cut
# lies at 10 mm. One row per run; a last argument "pure" takes pure discrete elements (a/d = 80: half an hour).
# usage: examples/cracked_plate/toughness.sh [directory of the programs] [pure]
set -eu
cd "$(dirname "$0")/../.."
programs=${1:-build/release/bin}
far=${2:+none}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# spacing, half height of the zone, cell size, all in mm
plate() {
  set -- "$1" "$2" "$3" "${far:-{\"cell_size\": \"$3 mm\", \"levels\": 1\}}"
  "$programs/ligament" run examples/cracked_plate/fast.json --output "$work/$1" --json \
    --set '/specimen/size=["40 mm", "100 mm"]' --set '/time/duration=1.6 ms' \
    --set '/loads/0/velocity=[null, "3.3 mm/s"]' --set '/loads/0/ramp=0.2 ms' \
    --set '/loads/1/velocity=[null, "-3.3 mm/s"]' --set '/loads/1/ramp=0.2 ms' \
    --set "/discrete_zone/spacing=$1 mm" \
    --set "/discrete_zone/region={\"lower\": [null, \"-$2 mm\"], \"upper\": [null, \"$2 mm\"]}" \
    --set "/far_field=$4" 2>/dev/null | tail -n 1 >"$work/json"
  sed -n 's/.*"wall_seconds":\([0-9.e+-]*\).*"peak_load":\([0-9.e+-]*\).*/\1 \2/p' "$work/json" |
    awk -v d="$1" '{
      pi = atan2(0, -1); w = 0.04; a = 0.01 + d * 1e-3 / 4; stress = $2 / w
      k = stress * sqrt(pi * a / cos(pi * a / w))
      printf "a/d %4.0f  peak %.4f MPa  K_c %.4f MPa m^0.5  K_c/K_Ic %.4f  %.0f s\n",
        10 / d, stress / 1e6, k / 1e6, k / 0.75e6, $1 }'
}

plate 0.5 17.6 2.07
plate 0.25 12 1.03
plate 0.125 8 0.515
