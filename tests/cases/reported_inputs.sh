#!/usr/bin/env bash
# Small inputs from public reports, each with what is right: crashes, poses that nothing measured, wrong answers without a
# word. Prints a line per input; exit status 0 if all are right, 1 if one is not, 77 (skipped) without the inputs.
#   tests/cases/reported_inputs.sh PROGRAM FOLDER
set -uo pipefail
export LC_ALL=C
program=$(realpath "$1")
cases=$2
if [[ ! -d $cases ]]; then
  echo "skipped: no reported inputs at $cases"
  exit 77
fi
cases=$(realpath "$cases")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0

check() {  # DESCRIPTION CONDITION...
  local what=$1
  shift
  if "$@"; then echo "right: $what"; else echo "WRONG: $what"; failed=1; fi
}
# Runs the program; standard output and error in `said`, exit status in `status`.
call() { status=0; "$program" "$@" >said 2>&1 || status=$?; }
ended() { [[ $status == "$1" ]]; }
said() { grep -qiE -e "$1" said; }
quiet_about() { ! said "$1"; }
number() { grep -oE "\"$1\": *[-0-9.e+]+" "$2" | head -1 | sed 's/.*: *//'; }
below() { awk -v a="${1:-nan}" -v b="$2" 'BEGIN { exit !(a == a + 0 && a < b) }'; }
near() { awk -v a="${1:-nan}" -v b="$2" 'BEGIN { d = a - b; exit !(a == a + 0 && d * d < 1e-6 * b * b) }'; }
refused() { ended 2 && [[ $(wc -l <said) == 1 ]] && said "$1"; }
error_of() { "$program" evaluate out "$1" --json 2>/dev/null >metrics; number ate_rmse_m metrics; }

in=$cases/01-crash-single-poses
for graph in two-poses two-poses-2d no-odometry; do
  call run "$in/$graph.g2o" -o out
  check "$graph.g2o ends with a result" ended 0
  call prune "$in/$graph.g2o" -o pairs
  check "$graph.g2o can be pruned" ended 0
done
for mission in mission one-scan-each; do
  call run "$in/$mission" -o out
  check "robots of one pose ($mission) end with a result" ended 0
done

in=$cases/02-gap-in-odometry-placed-at-origin
for graph in team team-one-bad-line one-robot.g2o; do
  call run "$in/$graph" -o out
  check "poses behind the gap of $graph are named" said "not placed|no pose|nothing (ties|measures)|gap"
  check "no pose of $graph behind the gap is at the origin" bash -c '! grep -hE "^1[0-9](\.0*)? 0 0 0 0 0 0 1$" out/*.tum'
done
call run "$in/no-information.g2o" -o out
check "a graph without any edge is refused" refused "."
call import dpgo "$in/gap.csv" -o gap.g2o
call run gap.g2o -o out
check "a gap in a DPGO file is named" said "not placed|no pose|nothing (ties|measures)|gap"
call run "$in/team-closed" -o out
check "a part that a loop ties is placed" ended 0
check "its poses have an uncertainty" awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  $column["robot"] == "a" && $column["t_s"] >= 10 && $column["sigma_m"] == 0 { zero = 1 } END { exit zero }' out/uncertainty.csv

in=$cases/03-distributed-stops-before-start
for method in separators asynchronous two-stage block-coordinate alternating; do
  call optimize --distributed "$method" "$in/team" -o out.g2o --json
  check "$method optimizes robots without neighbours" near "$(number final_cost said)" 6.58099
done

in=$cases/05-stripped-keys-merge-robots
for graph in stripped.g2o mixed; do
  call run "$in/$graph" -o out
  check "run refuses $graph: letters are missing" refused letter
done
call optimize --distributed separators "$in/stripped.g2o" -o out.g2o
check "optimize --distributed refuses it" refused letter

call optimize --distributed separators "$cases/07-distributed-hides-notes/team" -o out.g2o
check "a line that is left out is noted without --json" said "left out"

import_run() {  # SOURCE OPTIONS...: imports a bag into m and runs it
  rm -rf m out
  call import rosbag "$@" -o m
  cp said imported
  if ended 0; then call run m -o out; fi
}
import_run "$cases/08-constant-point-times/points.mcap" --odometry none --truth /truth
check "constant point times are ignored" below "$(error_of m)" 0.03

call import rosbag "$cases/09-half-of-split-recording-ignored/recording" -o m9
scans=$(find m9 -name '*.bin' 2>/dev/null | wc -l)
check "both parts of a split recording are read, or it is refused" test "$scans" != 20

for recording in zeros-after-record.bag zeros-in-chunk-accepted.bag corrupt-last-chunk.mcap corrupt-middle-chunk.mcap; do
  rm -rf m10
  call import rosbag "$cases/10-power-loss-refused/$recording" -o m10
  check "$recording is read as far as it is sound" ended 0
  check "what is lost of $recording is noted" said "note:"
done

for drive in north east; do
  import_run "$cases/11-first-fix-zero/$drive.mcap"
  check "a first fix of 0, 0 is none ($drive)" quiet_about "not used|scale error"
done

python=$(command -v /usr/bin/python3 || command -v python3)
if "$python" -c "import numpy" 2>/dev/null; then
  mkdir five && cp "$cases"/13-five-float-scans/*.py five && (cd five && "$python" make.py)
  call import kitti five/drive -o m13
  cp said imported
  call doctor m13
  check "scans of five floats a point are noticed" grep -qiE "float|values a point|layout" said imported
  call run m13 -o out
  check "they are read rightly, or refused" bash -c "[[ $status == 2 ]] || awk -v a='$(error_of m13)' 'BEGIN { exit !(a < 0.01) }'"
else
  echo "skipped: five floats a point (python3 has no numpy)"
fi

for log in log log-no-repeat; do
  call import iw "$cases/14-busybox-date/$log.txt" -o wifi.csv
  check "whole seconds of $log.txt are taken" grep -q '^1732600000' wifi.csv
done

for table in table table-es; do
  rm -f wifi.csv
  call import nmcli "$cases/15-nmcli-table/$table.txt" -o wifi.csv
  check "$table.txt is read, or refused with the command to use" bash -c "[[ $status == 0 && -s wifi.csv ]] || grep -q 'nmcli -t' said"
done

import_run "$cases/16-packets-per-sweep/packets.mcap" --odometry none --truth /truth
check "slices of sweeps are gathered" below "$(error_of m)" 0.02

for graph in reversed four-digits; do
  call optimize --distributed separators "$cases/17-duplicate-of-a-link-reversed/$graph" -o out.g2o --json
  check "the second copy of a link ($graph) counts once" below "$(number final_cost said)" 13.66
  call run "$cases/17-duplicate-of-a-link-reversed/$graph" -o out
  check "of run, too" said "counts? once"
done

in=$cases/20-lost-messages-converged/team
for method in two-stage block-coordinate separators alternating asynchronous; do
  call optimize --distributed "$method" "$in" -o out.g2o --loss-share 0.3 --json
  check "$method is at the optimum when it says so, or refuses losses" \
    bash -c "[[ $status == 2 ]] || ! grep -q '\"termination\": \"converged\"' said || awk -v a='$(number relative_gap said)' 'BEGIN { exit !(a < 1e-3) }'"
done

exit "$failed"
