#!/bin/sh
# Installs what is missing, builds Release, runs the cracked plate and makes its report.
# Further arguments go to `ligament run`, for example: --set /far_field=none
set -eu
cd "$(dirname "$0")/.."
# Open MPI refuses to start as root without these; the program runs on one rank.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
start=$(date +%s)
output=cracked_plate-out

echo "== 1/4 packages (a few minutes the first time, then a second)"
scripts/install_packages.sh
echo "== 2/4 build (some minutes the first time, then seconds)"
scripts/build.sh ligament
echo "== 3/4 run examples/cracked_plate (some seconds)"
build/release/bin/ligament run examples/cracked_plate/scene.json --output $output "$@"
echo "== 4/4 report"
build/release/bin/ligament report $output
echo "== done in $(($(date +%s) - start)) s; results are in $output/"
