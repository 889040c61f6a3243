#!/usr/bin/env bash
# Checks that take too long for every change: long fuzzing, a sweep over seeds, clang-tidy and benchmarks.
#   scripts/nightly.sh [FUZZ_SECONDS]     per fuzzer; default: 1800
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
fuzz_seconds=${1:-1800}

scripts/test.sh
scripts/deps.sh lint bench
scripts/format.sh --check

echo "== clang, optimised"
cmake --preset clang -DRADIOSLAM_GROUP_SOURCES=ON >/dev/null
cmake --build build/clang --parallel "$(nproc)"

echo "== clang-tidy"
cmake --preset clang -B build/tidy >/dev/null  # not a unity build; only for compile_commands.json, nothing is built
git ls-files -z 'src/*.cpp' | xargs -0 --max-args=4 --max-procs="$(nproc)" clang-tidy-14 --quiet -p build/tidy

echo "== car parks over ten seeds"
scripts/sweep.sh 10

echo "== benchmarks"
cmake --preset bench -DRADIOSLAM_GROUP_SOURCES=ON >/dev/null
cmake --build build/bench --parallel "$(nproc)" --target benchmarks
for benchmark in build/bench/bench/*_bench; do "$benchmark"; done

echo "== fuzzers"
scripts/fuzz.sh "$fuzz_seconds"
