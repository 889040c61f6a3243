#!/usr/bin/env bash
# Runs every fuzzer for a limited time, one per core in parallel, starting from its seeds and the corpus of earlier runs
# (build/fuzz-corpus).
#   scripts/fuzz.sh [SECONDS [SEED]]     per fuzzer; default: 60 s and a random seed
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
seconds=${1:-60}
seed=${2:-0}

fuzz_one() {
  local fuzzer=$1 name
  name=$(basename "$fuzzer")
  local corpus=build/fuzz-corpus/$name
  mkdir -p "$corpus" build/fuzz-findings
  echo "$name for $seconds s"
  "$fuzzer" -max_total_time="$seconds" -seed="$seed" -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 -verbosity=0 \
    -artifact_prefix="build/fuzz-findings/$name-" "$corpus" "tests/fuzz/seeds/${name#fuzz_}"
}
export -f fuzz_one
export seconds seed

scripts/deps.sh test
cmake --preset asan >/dev/null
cmake --build build/asan --target fuzzers --parallel "$(nproc)"
find build/asan/tests/fuzz -maxdepth 1 -name 'fuzz_*' -type f -executable -print0 | sort -z |
  xargs -0 --max-args=1 --max-procs="$(nproc)" bash -c 'fuzz_one "$1"' fuzz_one
