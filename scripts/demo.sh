#!/usr/bin/env bash
# Demonstration from a clean clone: builds radioslam, simulates robots in a car park, estimates their trajectories in
# one frame, and compares them with the ground truth.
#   scripts/demo.sh [FOLDER]      results in FOLDER; default: build/demo
set -euo pipefail
export LC_ALL=C
repository=$(cd "$(dirname "$0")/.." && pwd)
results=$(realpath -m "${1:-$repository/build/demo}")
cd "$repository"

scripts/deps.sh build
# The program alone needs no test packages; an existing build folder keeps its configuration.
if [[ -f build/release/CMakeCache.txt ]]; then
  cmake --preset release >/dev/null
else
  cmake --preset release -DRADIOSLAM_BUILD_TESTS=OFF -DRADIOSLAM_GROUP_SOURCES=ON >/dev/null
fi
cmake --build build/release --target radioslam_program

radioslam=build/release/radioslam
mkdir -p "$results"
"$radioslam" simulate carpark -o "$results/carpark" --seed 1
"$radioslam" run "$results/carpark" -o "$results/estimate"
"$radioslam" evaluate "$results/estimate" "$results/carpark"
echo
echo "Report: $results/estimate/report.html"
