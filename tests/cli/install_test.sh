#!/usr/bin/env bash
# Installs the project, then builds and runs the example outside of it.
#   install_test.sh SOURCE BUILD GENERATOR CXX CXX_FLAGS
set -euo pipefail
export LC_ALL=C
source=$1 build=$2 generator=$3 compiler=$4 flags=$5
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/prefix" >/dev/null
"$folder/prefix/bin/radioslam" --version
cmake -S "$source/examples/optimize_graph" -B "$folder/example" -G "$generator" \
  -DCMAKE_PREFIX_PATH="$folder/prefix" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$flags" >"$folder/log" || { cat "$folder/log"; exit 1; }
cmake --build "$folder/example" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
"$folder/example/optimize_graph" | tee "$folder/printed"
grep -q "after [0-9]* iterations" "$folder/printed"
