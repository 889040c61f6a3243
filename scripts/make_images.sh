#!/usr/bin/env bash
# Makes the pictures of the README: simulates missions, runs them, and photographs the maps of their reports with a
# headless Chromium (Debian package chromium).
#   scripts/make_images.sh [PROGRAM]      default: build/release/radioslam; pictures in docs/images
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
program=$(realpath "${1:-build/release/radioslam}")
max_bytes=200000
[[ -x $program ]] || { echo "make_images.sh: no program at $program" >&2; exit 2; }
command -v chromium >/dev/null || { echo "make_images.sh: chromium is missing (apt-get install chromium)" >&2; exit 2; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/images

# Leaves the map, its panel and its caption of a report, with the given layers switched off.
map_alone() {  # REPORT LAYER...
  local report=$1 layers
  shift
  layers=$(printf '"%s",' "$@")
  sed 's|</body>||; s|</html>||' "$report"
  cat <<END
<style>
  body, main { margin: 0 !important; padding: 0 !important; max-width: none !important; }
  main > :not(#map-section), #map-title, .map-buttons, .hint, .panel-buttons { display: none !important; }
  #map-section { margin: 8px 10px !important; }
  .map-canvas, .map-panel { height: 520px !important; }
</style>
<script>
  for (const label of document.querySelectorAll("#map-panel label"))
    if ([$layers].some(layer => label.textContent.includes(layer))) label.querySelector("input:checked")?.click();
</script>
</body></html>
END
}

photograph() {  # PAGE PICTURE WIDTH HEIGHT
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --force-device-scale-factor=1 \
    --virtual-time-budget=4000 --window-size="$3,$4" --screenshot="$2" "file://$1" 2>/dev/null
  local bytes
  bytes=$(stat -c %s "$2")
  echo "$2: $bytes bytes"
  ((bytes < max_bytes)) || { echo "make_images.sh: $2 is larger than $max_bytes bytes" >&2; exit 1; }
}

picture_of() {  # NAME SIMULATE-ARGUMENTS... -- LAYERS-OFF...
  local name=$1 arguments=()
  shift
  while [[ $1 != -- ]]; do arguments+=("$1"); shift; done
  shift
  "$program" simulate "${arguments[@]}" -o "$work/$name"
  "$program" run "$work/$name" -o "$work/$name-out"
  map_alone "$work/$name-out/report.html" "$@" >"$work/$name.html"
  photograph "$work/$name.html" "docs/images/$name.png" 1080 590
}

picture_of carpark carpark --robots 3 -- "access point"
picture_of hall hall --robots 1 --set lidar_beams=16 imu_hz=200 -- "odometry only"
