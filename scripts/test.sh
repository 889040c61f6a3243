#!/usr/bin/env bash
# Checks how the sources are divided (scripts/check_structure.py), then builds and tests everything: release, with g++.
#   scripts/test.sh [--all]     --all: then with AddressSanitizer and UndefinedBehaviorSanitizer (clang), and every
#                               fuzzer of that build for two seconds with a fixed seed
# Tests that simulate for long run without sanitizers only; scripts/nightly.sh runs them with, and fuzzes from random seeds.
# All builds treat warnings as errors and compile sources in groups, which halves the time of a build from scratch.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
if (($# > 1)) || [[ ${1:-} != "" && ${1:-} != --all ]]; then
  echo "usage: scripts/test.sh [--all]" >&2
  exit 2
fi

jobs=$(nproc)
step() { printf '\n== %s (%d s so far)\n' "$1" "$SECONDS"; }

configure_and_build() {
  cmake --preset "$1" "${@:2}" >/dev/null
  cmake --build "build/$1" --parallel "$jobs"
}

# Runs the tests of a preset, all or those that further arguments of ctest select. Counts them: to ctest, a run of a
# test program is one test.
run_tests() {
  local log=build/$1/ctest.log status=0
  ctest --test-dir "build/$1" --parallel "$jobs" --output-on-failure "${@:2}" | tee "$log" || status=$?
  awk '/^\[  PASSED  \] [0-9]+ test/ {passed += $4}
       /^\[  SKIPPED \] [0-9]+ test/ {skipped += $4}
       /^\[  FAILED  \] [0-9]+ test/ {failed += $4}
       END {printf "%d tests passed, %d failed, %d skipped\n", passed, failed, skipped}' \
    "build/$1/Testing/Temporary/LastTest.log" | tee -a "$log"
  return "$status"
}

rm -f build/release/ctest.log
step "packages"
scripts/deps.sh test

step "structure"
scripts/check_structure.py

step "release"
configure_and_build release -DRADIOSLAM_BUILD_TESTS=ON -DRADIOSLAM_GROUP_SOURCES=ON -DRADIOSLAM_TEST_SHARDS=2
scripts/check_words.sh build/release/radioslam
run_tests release

step "network"
status=0
scripts/team_network.sh --short build/release/team-network || status=$?
if ((status != 0 && status != 77)); then exit "$status"; fi
if [[ ${1:-} != --all ]]; then exit 0; fi

step "sanitizers"
configure_and_build asan
run_tests asan --label-exclude slow  # scripts/nightly.sh slow

step "fuzzers"
scripts/fuzz.sh 2 1

step "done"
