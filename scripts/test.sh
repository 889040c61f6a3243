#!/usr/bin/env bash
# Checks how the sources are divided (scripts/check_structure.py). Then builds and tests everything: release with g++,
# then AddressSanitizer and UndefinedBehaviorSanitizer with clang,
# then runs every fuzzer of the sanitizer build for two seconds with a fixed seed (scripts/nightly.sh uses random ones).
# All builds treat warnings as errors and compile sources in groups, which halves the time of a build from scratch.
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

step "structure"
scripts/check_structure.py

step "release"
configure_and_build release -DRADIOSLAM_BUILD_TESTS=ON -DRADIOSLAM_GROUP_SOURCES=ON
scripts/check_words.sh build/release/radioslam
run_tests release
if [[ ${1:-} == --quick ]]; then exit 0; fi

step "sanitizers"
configure_and_build asan
run_tests asan

step "fuzzers"
scripts/fuzz.sh 2 1

step "done"
