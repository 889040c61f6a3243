#!/usr/bin/env bash
# Writes docs/parameters.md, the list of all parameters, from the program's own list.
#   scripts/parameters_page.sh [PROGRAM]     default: build/release/radioslam
set -euo pipefail
export LC_ALL=C
program=$(realpath "${1:-$(dirname "$0")/../build/release/radioslam}")
cd "$(dirname "$0")/.."
page=$("$program" parameters --page)
printf '%s\n' "$page" > docs/parameters.md
