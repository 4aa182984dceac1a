#!/bin/sh
# Configures and builds the release preset in build/release: scripts/build.sh [targets...]
set -eu
cd "$(dirname "$0")/.."

# A file that includes deal.II's large headers takes 1.2 GB to compile: two at a time at most.
jobs=2
memory_mb=$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo 2>/dev/null || echo 4096)
if [ "$(nproc)" -lt 2 ] || [ "$memory_mb" -lt 3500 ]; then
  jobs=1
fi

cmake --preset release
if [ $# -gt 0 ]; then
  cmake --build build/release --parallel $jobs --target "$@"
else
  cmake --build build/release --parallel $jobs
fi
