#!/usr/bin/env bash
# Builds all fuzzers with sanitizers and runs each, as many in parallel as there are cores, starting from its seeds and
# the corpus of earlier runs (build/fuzz-corpus).
#   scripts/fuzz.sh [SECONDS [SEED]]       SECONDS per fuzzer; default: 60 s and a random seed
#   scripts/fuzz.sh --within SECONDS       all fuzzers, and building them, within SECONDS
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
within=0
if [[ ${1:-} == --within ]]; then
  within=$2
  shift 2
fi
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

jobs=$(nproc)
scripts/deps.sh test
cmake --preset asan >/dev/null
cmake --build build/asan --target fuzzers --parallel "$jobs"
mapfile -t fuzzers < <(find build/asan/tests/fuzz -maxdepth 1 -name 'fuzz_*' -type f -executable | sort)
if ((within > 0)); then
  # Each takes about two seconds more than its time: to start, and to read its corpus.
  turns=$(((${#fuzzers[@]} + jobs - 1) / jobs))
  seconds=$(((within - SECONDS) * 95 / 100 / turns - 2))
  if ((seconds < 1)); then
    echo "scripts/fuzz.sh: no time left to fuzz" >&2
    exit 124  # as timeout says it
  fi
fi
export seconds seed
printf '%s\0' "${fuzzers[@]}" | xargs -0 --max-args=1 --max-procs="$jobs" bash -c 'fuzz_one "$1"' fuzz_one
