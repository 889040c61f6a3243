#!/usr/bin/env bash
# Trajectory error over many simulated car parks: one row per seed.
#   scripts/sweep.sh [SEEDS] [name=value ...]     further arguments are passed to `radioslam run --set`
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
seeds=${1:-10}
shift || true
settings=()
for setting in "$@"; do settings+=(--set "$setting"); done

radioslam=build/release/radioslam
[[ -x $radioslam ]] || { echo "scripts/sweep.sh: build $radioslam first (scripts/test.sh)" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for ((seed = 1; seed <= seeds; ++seed)); do
  "$radioslam" simulate carpark -o "$folder/mission" --seed "$seed"
  "$radioslam" run "$folder/mission" -o "$folder/estimate" "${settings[@]}"
  printf '%s\t' "$seed"
  "$radioslam" evaluate "$folder/estimate" "$folder/mission" --json | tr -d ' \n' |
    sed -E 's/.*"ate_rmse_m":([^,}]*).*/ate_rmse_m \1\n/'
done
