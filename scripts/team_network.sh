#!/usr/bin/env bash
# A team of processes on a bad network: a network namespace per robot on one bridge, nftables that lose messages.
#   scripts/team_network.sh [--short] [FOLDER]     results in FOLDER; default: build/team-network
# Three robots of a simulated town, replayed ten times as fast as they were recorded: 30 % of all packets are lost each
# way, robot a is cut off for 60 s of the mission, robot b's program is killed and started again, and robot c joins at
# half of the mission. Every agent must end within 5 % and 2 cm of `radioslam run`. --short: a mission of one minute at
# five times its speed, a partition of 15 s, and within 10 % and 10 cm, since much less was measured.
# Needs root (or sudo), ip and nft; without, it says so and ends with status 77. Leaves no namespace behind.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."

short=0
if [[ ${1:-} == --short ]]; then short=1; shift; fi
if (($# > 1)) || [[ ${1:-} == -* ]]; then
  echo "usage: scripts/team_network.sh [--short] [FOLDER]" >&2
  exit 2
fi
folder=$(realpath -m "${1:-build/team-network}")
bin=$(realpath build/release)
robots=(a b c)
id=$$  # several may run at once
bridge=rs$((id % 100000))
subnet=10.$((id / 250 % 250)).$((id % 250))

as_root() { if [[ $(id -u) == 0 ]]; then "$@"; else sudo -n "$@"; fi; }
space() { echo "$bridge-$1"; }
inside() { as_root ip netns exec "$(space "$1")" "${@:2}"; }

if ! command -v nft >/dev/null || ! command -v ip >/dev/null || ! as_root ip netns add "$(space probe)" 2>/dev/null; then
  echo "scripts/team_network.sh: skipped, network namespaces cannot be made here (needs root, ip and nft)"
  exit 77
fi
as_root ip netns delete "$(space probe)"

agents=()
tear_down() {
  for robot in "${robots[@]}"; do
    as_root ip netns pids "$(space "$robot")" 2>/dev/null | xargs -r kill -9 2>/dev/null || true
    as_root ip netns delete "$(space "$robot")" 2>/dev/null || true
  done
  as_root ip link delete "$bridge" 2>/dev/null || true
}
trap tear_down EXIT

set_up() {
  as_root ip link add "$bridge" type bridge
  as_root ip link set "$bridge" up
  local n=0 robot
  for robot in "${robots[@]}"; do
    n=$((n + 1))
    as_root ip netns add "$(space "$robot")"
    as_root ip link add "$bridge$robot" type veth peer name air netns "$(space "$robot")"
    as_root ip link set "$bridge$robot" master "$bridge" up
    inside "$robot" ip address add "$subnet.$n/24" dev air
    inside "$robot" ip link set air up
    inside "$robot" ip link set lo up
    inside "$robot" nft -f - <<'RULES'
table inet air {
  chain lost { type filter hook input priority 0; iif "air" numgen random mod 100 < 30 counter drop; }
}
RULES
  done
}

cut_off() { inside "$1" nft add rule inet air lost iif air counter drop comment "partition"; }
join() {
  local handle
  handle=$(inside "$1" nft -a list chain inet air lost | sed -n 's/.*partition.*handle //p')
  inside "$1" nft delete rule inet air lost handle "$handle"
}

# Seconds of the mission since its begin, as a time to sleep until.
sleep_until() { sleep "$(awk -v at="$1" -v start="$start" -v rate="$rate" -v now="$(date +%s.%N)" \
  'BEGIN {left = start + at / rate - now; print (left > 0 ? left : 0)}')"; }

start_agent() {
  inside "$1" setpriv --pdeathsig KILL "$bin/radioslam-agent" --robot "$1" --log "$folder/town" --rate "$rate" \
    --start "$start" --interface air --peer "$subnet.1" --peer "$subnet.2" --peer "$subnet.3" \
    --journal "$folder/$1.journal" -o "$folder/agents/$1" >>"$folder/$1.log" 2>&1 &
  agents[$(printf '%d' "'$1")]=$!
}

rm -rf "$folder"
mkdir -p "$folder"
if ((short)); then
  rate=5 length=240 from=15 to=30 kill_at=35 back_at=40
else
  rate=10 length=1200 from=110 to=170 kill_at=180 back_at=190
fi
"$bin/radioslam" simulate city --robots 3 --seed 1 -o "$folder/town" --set path_length_m="$length" speed_mps=4 >/dev/null
"$bin/radioslam" run "$folder/town" -o "$folder/run" >/dev/null
late=$((length / 4 / 2))

set_up
start=$(awk -v now="$(date +%s.%N)" 'BEGIN {printf "%.3f", now + 2}')
start_agent a
start_agent b
sleep_until "$from"; cut_off a
# What comes at which time depends on the mission's length.
events=("$to join a" "$kill_at killed b" "$back_at start_agent b" "$late start_agent c")
killed() { inside "$1" pkill -9 -f -- "--robot $1 " || true; }
while read -r at what robot; do
  sleep_until "$at"
  "$what" "$robot"
done < <(printf '%s\n' "${events[@]}" | sort -n)
status=0
for robot in "${robots[@]}"; do wait "${agents[$(printf '%d' "'$robot")]}" || status=1; done
for robot in "${robots[@]}"; do
  lost=$(inside "$robot" nft list chain inet air lost | sed -n 's/.*< 30 counter packets \([0-9]*\).*/\1/p')
  echo "agent $robot: $lost packets lost on their way to it, $(inside "$robot" cat /sys/class/net/air/statistics/rx_packets) received"
done

python3 - "$folder" "$short" "${robots[@]}" <<'PYTHON' || status=1
import json, sys
folder, short, robots = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
def error(path):
    return json.load(open(path))["metrics"]["ate_rmse_m"]
batch = error(f"{folder}/run/summary.json")
limit = 1.1 * batch + 0.1 if short else 1.05 * batch + 0.02
print(f"run: {batch:.3f} m, limit for agents {limit:.3f} m")
failed = False
for robot in robots:
    try:
        of = error(f"{folder}/agents/{robot}/summary.json")
    except (OSError, KeyError, TypeError) as problem:
        print(f"agent {robot}: no result ({problem})")
        failed = True
        continue
    print(f"agent {robot}: {of:.3f} m")
    failed |= of > limit
sys.exit(failed)
PYTHON
if ((status)); then
  echo "scripts/team_network.sh: failed; what the agents said is in $folder/*.log" >&2
fi
exit "$status"
