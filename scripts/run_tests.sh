#!/bin/sh
# Installs what is missing, builds Release, runs all tests except those labelled slow.
# Further arguments go to ctest, for example: -R layers
set -eu
cd "$(dirname "$0")/.."
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

echo "== 1/3 packages (a few minutes the first time, then a second)"
scripts/install_packages.sh lammps-data # tables of interatomic potentials
echo "== 2/3 build with tests (some minutes the first time, then seconds)"
scripts/build.sh
echo "== 3/3 tests"
cd build/release
exec ctest --no-tests=error --label-exclude slow --output-on-failure --parallel "$(nproc)" "$@"
