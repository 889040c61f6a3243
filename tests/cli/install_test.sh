#!/usr/bin/env bash
# Installs the project, then builds and runs the examples against the installation.
#   install_test.sh SOURCE BUILD GENERATOR CXX CXX_FLAGS
set -euo pipefail
export LC_ALL=C
source=$1 build=$2 generator=$3 compiler=$4 flags=$5
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

quietly() { "$@" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }; }

# example NAME WORDS: builds and runs the example; its output must contain the words.
example() {
  quietly cmake -S "$source/examples/$1" -B "$folder/$1" -G "$generator" -DCMAKE_PREFIX_PATH="$folder/prefix" \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$flags"
  quietly cmake --build "$folder/$1"
  "$folder/$1/$1" | tee "$folder/printed"
  grep -q "$2" "$folder/printed"
}

cmake --install "$build" --prefix "$folder/prefix" >/dev/null
"$folder/prefix/bin/radioslam" --version
example optimize_graph "after [0-9]* iterations"
example overlap_candidates "of 40000 pairs could overlap"
