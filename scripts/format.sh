#!/usr/bin/env bash
# Formats the C++ sources in place; with --check, only checks whether they are formatted.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."

mode=(-i)
if [[ ${1:-} == --check ]]; then mode=(--dry-run --Werror); fi
git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-14 "${mode[@]}"
