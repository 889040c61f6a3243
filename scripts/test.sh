#!/usr/bin/env bash
# Builds and tests everything: release with g++, then AddressSanitizer and UndefinedBehaviorSanitizer with clang,
# then two seconds of every fuzzer from the same build, from one seed (the nightly takes others). All with
# warnings as errors, and as unity builds (several sources at once), which take half the time from nothing.
#   scripts/test.sh [--quick]     --quick: release only
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
if (($# > 1)) || [[ ${1:-} != "" && ${1:-} != --quick ]]; then
  echo "usage: scripts/test.sh [--quick]" >&2
  exit 2
fi

jobs=$(nproc)
step() { printf '\n== %s (%d s so far)\n' "$1" "$SECONDS"; }

configure_and_build() {
  cmake --preset "$1" "${@:2}" >/dev/null
  cmake --build "build/$1" --parallel "$jobs"
}

run_tests() {
  ctest --test-dir "build/$1" --parallel "$jobs" --output-on-failure | tee "build/$1/ctest.log"
}

rm -f build/release/ctest.log
step "packages"
scripts/deps.sh test

step "release"
configure_and_build release -DRADIOSLAM_BUILD_TESTS=ON -DCMAKE_UNITY_BUILD=ON
run_tests release
if [[ ${1:-} == --quick ]]; then exit 0; fi

step "sanitizers"
configure_and_build asan
run_tests asan

step "fuzzers"
scripts/fuzz.sh 2 1

step "done"
