#!/usr/bin/env bash
# Installs missing Debian (bookworm) packages.
#   scripts/deps.sh [build|test|lint|bench ...]     default: build
set -euo pipefail
export LC_ALL=C DEBIAN_FRONTEND=noninteractive

build=(cmake ninja-build g++ libeigen3-dev libnanoflann-dev libmetis-dev libsuitesparse-dev libyaml-cpp-dev libzstd-dev
       zlib1g-dev libbz2-dev liblz4-dev libsqlite3-dev libpcap-dev libcli11-dev nlohmann-json3-dev
       cyclonedds-dev libcpp-httplib-dev node-d3)
test=(libgtest-dev libceres-dev libfastrtps-dev libfastcdr-dev clang-14 libclang-rt-14-dev python3
      python3-rosidl python3-empy python3-lark iproute2 nftables procps)
lint=(clang-format-14 clang-tidy-14)
bench=(libbenchmark-dev)

is_installed() { [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

as_root() {
  if [[ $(id -u) == 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo --preserve-env=LC_ALL,DEBIAN_FRONTEND "$@"
  else
    echo "scripts/deps.sh: become root (or install sudo) to run: $*" >&2
    return 1
  fi
}

wanted=()
for set in "${@:-build}"; do
  case $set in
    build) wanted+=("${build[@]}") ;;
    test) wanted+=("${build[@]}" "${test[@]}") ;;
    lint) wanted+=("${build[@]}" "${lint[@]}") ;;
    bench) wanted+=("${build[@]}" "${bench[@]}") ;;
    *) echo "scripts/deps.sh: '$set' is not one of build, test, lint, bench" >&2; exit 2 ;;
  esac
done

if ! command -v dpkg-query >/dev/null; then
  echo "scripts/deps.sh: not a Debian system; install the equivalents of these packages: ${wanted[*]}" >&2
  exit 0
fi

missing=()
for package in "${wanted[@]}"; do is_installed "$package" || missing+=("$package"); done
if ((${#missing[@]} == 0)); then exit 0; fi
echo "installing: ${missing[*]}"
as_root apt-get -qq update
as_root apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
