#!/usr/bin/env bash
# Runs every fuzzer for a while, each from its seeds and the inputs it kept last time (build/fuzz-corpus).
#   scripts/fuzz.sh [SECONDS]     per fuzzer; default: 60
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
seconds=${1:-60}

scripts/deps.sh test
cmake --preset fuzz >/dev/null
cmake --build build/fuzz
for fuzzer in build/fuzz/tests/fuzz/fuzz_*; do
  [[ -f $fuzzer && -x $fuzzer ]] || continue
  name=$(basename "$fuzzer")
  corpus=build/fuzz-corpus/$name
  mkdir -p "$corpus" build/fuzz-findings
  echo "$name for $seconds s"
  "$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 -verbosity=0 \
    -artifact_prefix="build/fuzz-findings/$name-" "$corpus" "tests/fuzz/seeds/${name#fuzz_}"
done
