#!/bin/sh
# Builds the tests with the address and undefined-behaviour sanitizers (preset sanitize) and runs
# them, those on ranks on one and two; slow ones are left out. Ends with the first wrong access.
#   scripts/sanitize.sh [--trap-fp] [tests...]    for example: scripts/sanitize.sh test_core
# With --trap-fp tests end, too, where a number is made that is none (tests/support/trap_fp.cc).
set -eu
cd "$(dirname "$0")/.."
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
if [ "${1:-}" = --trap-fp ]; then
  export LIGAMENT_TRAP_FP=1
  shift
fi
export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
export UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"
export LSAN_OPTIONS="suppressions=$PWD/scripts/sanitize_leaks.txt:print_suppressions=0"

cmake --preset sanitize
pattern=$(printf '%s|' "$@")
if [ $# -gt 0 ]; then
  cmake --build build/sanitize --parallel "${JOBS:-1}" --target "$@"
else
  cmake --build build/sanitize --parallel "${JOBS:-1}"
  pattern='.*|'
fi
exec ctest --test-dir build/sanitize --no-tests=error --output-on-failure --label-exclude slow \
  --exclude-regex '_on_[34]$' --tests-regex "^(${pattern%|})(_on_[12])?\$"
