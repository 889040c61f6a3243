#!/usr/bin/env bash
# From a clean clone to a table and a page: builds radioslam, simulates robots in a car park, puts them into one
# frame and compares with the truth.
#   scripts/demo.sh [FOLDER]      results in FOLDER; default: build/demo
set -euo pipefail
export LC_ALL=C
repository=$(cd "$(dirname "$0")/.." && pwd)
results=$(realpath -m "${1:-$repository/build/demo}")
cd "$repository"

scripts/deps.sh build
# The program alone needs no test packages; a build folder that has them keeps them.
if [[ -f build/release/CMakeCache.txt ]]; then
  cmake --preset release >/dev/null
else
  cmake --preset release -DRADIOSLAM_BUILD_TESTS=OFF -DCMAKE_UNITY_BUILD=ON >/dev/null
fi
cmake --build build/release --target radioslam_program

radioslam=build/release/radioslam
mkdir -p "$results"
"$radioslam" simulate carpark -o "$results/carpark" --seed 1
"$radioslam" run "$results/carpark" -o "$results/estimate"
"$radioslam" evaluate "$results/estimate" "$results/carpark"
echo
echo "The page: $results/estimate/report.html"
