#!/bin/sh
# Builds the tests with the address and undefined-behaviour sanitizers (preset sanitize) and runs
# them, those on ranks on one and two; slow ones are left out. Ends with the first wrong access.
#   scripts/sanitize.sh [--clang | --fast] [--trap-fp] [tests...]    for example: scripts/sanitize.sh test_core
# With --clang the build is Clang's (preset trust), which counts lines, too: then a table of the
# shares that ran follows, per folder; a list of all files goes to build/trust/coverage.csv.
# With --fast it is Clang's against release libraries, for one vector target, without counters (preset
# sanitize-fast): tests of whole runs take some twenty times as long as without sanitizers.
# With --trap-fp tests end, too, where a number is made that is none (tests/support/trap_fp.cc).
set -eu
cd "$(dirname "$0")/.."
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
build=sanitize
while :; do
  case "${1:-}" in
  --clang) build=trust ;;
  --fast) build=sanitize-fast ;;
  --trap-fp) export LIGAMENT_TRAP_FP=1 ;;
  *) break ;;
  esac
  shift
done
export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
export UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"
export LSAN_OPTIONS="suppressions=$PWD/scripts/sanitize_leaks.txt:print_suppressions=0"
# Processes that run at once share a few files.
export LLVM_PROFILE_FILE="$PWD/build/$build/profiles/%4m.profraw"

cmake --preset $build
pattern=$(printf '%s|' "$@")
if [ $# -gt 0 ]; then
  cmake --build build/$build --parallel "${JOBS:-1}" --target "$@"
else
  cmake --build build/$build --parallel "${JOBS:-1}"
  pattern='.*|'
fi
rm -rf "build/$build/profiles"
status=0
ctest --test-dir build/$build --no-tests=error --output-on-failure --label-exclude slow \
  --exclude-regex '_on_[34]$' --tests-regex "^(${pattern%|})(_on_[12])?\$" || status=$?
[ $build != trust ] || python3 scripts/coverage_table.py build/$build
exit $status
