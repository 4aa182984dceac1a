#!/bin/sh
# Builds the unit tests of core, particles, packings and dem, of the coupling, ranks, scenes and
# whole bodies with counters of lines, runs them (ranks: one and two) and prints the share of lines
# that ran, per folder:
#   scripts/coverage.sh [tests...]     for example: scripts/coverage.sh test_core test_packings
# A list of all files goes to build/coverage/coverage.csv.
set -eu
cd "$(dirname "$0")/.."
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

[ $# -gt 0 ] || set -- test_core test_particles test_packings test_dem test_unit_coupling \
  test_unit_coupling_crystal test_ranks test_scene test_simulation
cmake --preset coverage
cmake --build build/coverage --parallel "${JOBS:-1}" --target "$@"
find build/coverage -name '*.gcda' -delete
pattern=$(printf '%s|' "$@")
status=0
ctest --test-dir build/coverage --no-tests=error --output-on-failure --label-exclude slow \
  --tests-regex "^(${pattern%|})(_on_[12])?\$" || status=$?
python3 scripts/coverage_table.py build/coverage
exit $status
