#!/usr/bin/env bash
# What takes too long for every change: long fuzzing, a sweep over seeds, clang-tidy and the benchmarks.
#   scripts/nightly.sh [FUZZ_SECONDS]     per fuzzer; default: 1800
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
fuzz_seconds=${1:-1800}

scripts/test.sh
scripts/deps.sh lint bench
scripts/format.sh --check

echo "== clang, optimised"
cmake --preset clang >/dev/null
cmake --build build/clang --parallel "$(nproc)"

echo "== clang-tidy"
git ls-files -z 'src/*.cpp' | xargs -0 --max-args=4 --max-procs="$(nproc)" clang-tidy-14 --quiet -p build/clang

echo "== car parks over ten seeds"
scripts/sweep.sh 10

if [[ -f bench/CMakeLists.txt ]]; then
  echo "== benchmarks"
  cmake --preset bench >/dev/null
  cmake --build build/bench
  for benchmark in build/bench/bench/*_bench; do "$benchmark"; done
fi

echo "== fuzzers"
scripts/fuzz.sh "$fuzz_seconds"
