#!/usr/bin/env bash
# Checks that take too long for every change, within a given time. The parts, what matters most first:
#   test    scripts/test.sh --all: release and sanitizer builds, all tests, two seconds of every fuzzer
#   slow    with sanitizers, the tests that simulate for long
#   fuzz    the fuzzers from random seeds, each for the same share of the part's time
#   threads tests of agents, their transport and page, with the thread sanitizer
#   soak    a team at ten times its mission's speed, whose memory must not grow once the robots stand
#   clang   an optimized clang build of everything, and its tests
#   sweep   trajectory errors of car parks over ten seeds
#   tidy    clang-format and clang-tidy, sources changed last first
#   bench   the benchmarks
#   scripts/nightly.sh [MINUTES]           all parts; default: 60 minutes in all
#   scripts/nightly.sh PART [MINUTES]      one part alone; default: 60 minutes
# `test` may take all the time. Each later part may take its share (below) of what is then left, so a part that ends
# early leaves more to the others. A part out of time is ended; builds go on from there in the next run.
# Exit status: 0 nothing failed (though parts may be cut short), 1 a part failed, 2 wrong call.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."

parts=(test slow fuzz threads soak clang sweep tidy bench)
declare -A share=([test]=1000 [slow]=4 [fuzz]=6 [threads]=5 [soak]=3 [clang]=5 [sweep]=2 [tidy]=5 [bench]=3)
least_s=20  # with less than this left, a part is not begun

usage() { sed -n '/^#   scripts/s/^#   /usage: /p' "$0" >&2; exit 2; }
if [[ -n ${share[${1:-none}]:-} ]]; then
  parts=("$1")
  shift
fi
minutes=${1:-60}
if (($# > 1)) || ! [[ $minutes =~ ^[1-9][0-9]{0,3}$ ]]; then usage; fi

jobs=$(nproc)
export jobs

part_test() { scripts/test.sh --all; }

part_slow() {
  scripts/deps.sh test
  cmake --preset asan >/dev/null
  cmake --build build/asan --parallel "$jobs"
  ctest --test-dir build/asan --parallel "$jobs" --output-on-failure --label-regex '^slow$'
}

part_fuzz() { scripts/fuzz.sh --within "$1"; }

part_threads() {
  local rooms=(team io_dds io_live agent) room
  scripts/deps.sh test
  cmake --preset tsan >/dev/null
  cmake --build build/tsan --parallel "$jobs" --target "${rooms[@]/%/_tests}"
  export TSAN_OPTIONS=ignore_noninstrumented_modules=1  # the DDS library synchronises by what the sanitizer does not see
  for room in "${rooms[@]}"; do
    # Without random addresses, which older versions of the sanitizer do not have room for.
    setarch --addr-no-randomize "$(find build/tsan -name "${room}_tests" -type f)" --gtest_brief=1
  done
}

part_soak() {
  scripts/deps.sh
  cmake --preset release -DRADIOSLAM_GROUP_SOURCES=ON >/dev/null
  cmake --build build/release --parallel "$jobs" --target radioslam_program radioslam_agent
  scripts/team_load.py --soak "$((($1 + 60) / 120))"  # the other half for the build
}

part_clang() {
  scripts/deps.sh test
  cmake --preset clang -DRADIOSLAM_GROUP_SOURCES=ON -DRADIOSLAM_TEST_SHARDS=2 >/dev/null
  cmake --build build/clang --parallel "$jobs"
  ctest --test-dir build/clang --parallel "$jobs" --output-on-failure
}

part_sweep() {
  scripts/deps.sh
  cmake --preset release -DRADIOSLAM_GROUP_SOURCES=ON >/dev/null
  cmake --build build/release --parallel "$jobs" --target radioslam_program
  scripts/sweep.sh 10
}

part_tidy() {
  scripts/deps.sh lint
  scripts/format.sh --check
  cmake --preset clang -B build/tidy >/dev/null  # ungrouped; only for compile_commands.json, nothing is built
  git log --format= --name-only -- 'src/*.cpp' | awk '!seen[$0]++' | while read -r source; do
    if [[ -e $source ]]; then printf '%s\0' "$source"; fi
  done | xargs -0 --max-args=4 --max-procs="$jobs" clang-tidy-14 --quiet -p build/tidy
}

part_bench() {
  scripts/deps.sh bench
  cmake --preset bench -DRADIOSLAM_GROUP_SOURCES=ON -DRADIOSLAM_BUILD_TESTS=OFF >/dev/null
  cmake --build build/bench --parallel "$jobs" --target benchmarks
  for benchmark in build/bench/bench/*_bench; do "$benchmark"; done
}

# Seconds that the part at an index may take, of those left.
budget_s() {
  local left=$1 index=$2 total=0 part
  for part in "${parts[@]:index}"; do total=$((total + share[$part])); done
  part=${parts[index]}
  if [[ $part == test ]]; then echo "$left"; else echo $((left * share[$part] / total)); fi
}

export -f part_test part_slow part_fuzz part_threads part_soak part_clang part_sweep part_tidy part_bench
end_s=$((60 * minutes))
failed=0
summary=()
for index in "${!parts[@]}"; do
  part=${parts[index]}
  seconds=$(budget_s $((end_s - SECONDS)) "$index")
  if ((seconds < least_s)); then
    summary+=("$(printf '%-7s not reached' "$part")")
    continue
  fi
  printf '\n== %s: at most %d s (%d s so far)\n' "$part" "$seconds" "$SECONDS"
  begin_s=$SECONDS status=0
  timeout --kill-after=10 "$seconds" bash -euo pipefail -c "part_$part $seconds" &
  trap "kill $!; exit 130" INT TERM
  wait $! || status=$?
  case $status in
    0) result="done" ;;
    124 | 137) result="cut short" ;;
    *) result="FAILED (exit status $status)" failed=1 ;;
  esac
  summary+=("$(printf '%-7s %s after %d s' "$part" "$result" $((SECONDS - begin_s)))")
done

printf '\n== nightly checks: %d s of %d\n' "$SECONDS" "$end_s"
printf '%s\n' "${summary[@]}"
exit "$failed"
