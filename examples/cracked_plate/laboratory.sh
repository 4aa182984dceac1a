#!/bin/sh
# The cracked plate at 1e-5/s: equilibria up to the first break, time steps while the crack runs.
# laboratory.sh [DIR]
set -eu
cd "$(dirname "$0")/../.."
exec "${LIGAMENT:-build/release/bin/ligament}" run examples/cracked_plate/scene.json \
  --set '/loads/0/velocity=[null, "2 um/s"]' --set '/loads/0/ramp="0.1 s"' \
  --set '/loads/1/velocity=[null, "-2 um/s"]' --set '/loads/1/ramp="0.1 s"' \
  --set '/time/duration="12 s"' --set '/time/loading="static"' \
  --set '/output/field_interval="1 s"' --output "${1:-laboratory-out}"
