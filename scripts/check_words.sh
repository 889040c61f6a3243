#!/usr/bin/env bash
# Refuses words of a private dialect in what readers see first: headers, help texts and the README. The field has
# words for all of them (docs/glossary.md).
#   scripts/check_words.sh [PROGRAM]      default: build/release/radioslam; without it, help texts are not checked
# Exit status: 0 nothing refused, 1 something refused (one line each), 2 wrong call.
set -euo pipefail
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/.."

# Refused words, with what the field says instead.
words=(
  tell tells told telling untold   # states, constrains, observes; distinguishes
  unbent unbend unbends unbending  # deskewed, motion-compensated
  straighten straightens straightened  # deskew; correct
  anew afar likewise thereof       # again, far, the same
  ghost ghosts                     # cross term, false peak
  rival rivals                     # alternative
  wild tame                        # outlier, inlier
  honest                           # consistent (of covariances)
  walked                           # travelled
  usual usually unusual            # nominal, typical
  lonely stray                     # isolated, outlying
  silent silence                   # undetected
  ours                             # this project's, measured here
  "the seed's" "the seeds'"        # the paper by name
  taught patience                  # learnt; stopping criterion
  spoilt surer verdict verdicts    # corrupted, more certain, test or status
  "as heard" "made up" "says nothing" "speaks of" "heard along"
)

# Fixed words of formats and of the command line, in the only places where they may occur: FILE|TEXT.
exceptions=(
  'src/radioslam/report/aoa_data.hpp|"ghost"'           # key of the report's data
  'src/radioslam/report/access_point_data.hpp|"rival"'  # key of the report's data
  'src/radioslam/study/study_json.hpp|"ours"'           # keys of a study's JSON
  'src/radioslam/study/study_json.hpp|"ghosts"'
)

if (($# > 1)); then
  echo "usage: scripts/check_words.sh [PROGRAM]" >&2
  exit 2
fi
pattern="\\b($(IFS='|'; echo "${words[*]}"))\\b"
status=0

# Prints NAME:LINE:TEXT of every line on standard input that has a refused word, exceptions of NAME removed.
refuse_in() {  # NAME
  local text
  text=$(cat)
  for exception in "${exceptions[@]}"; do
    if [[ ${exception%%|*} == "$1" ]]; then text=${text//"${exception#*|}"/}; fi
  done
  if grep -niP "$pattern" <<<"$text" | sed "s|^|$1:|"; then status=1; fi
}

while IFS= read -r header; do refuse_in "$header" <"$header"; done < <(find src -name '*.hpp' | sort)
refuse_in README.md <README.md

if [[ $# == 1 && ! -x $1 ]]; then
  echo "check_words.sh: no program at $1" >&2
  exit 2
fi
program=${1:-build/release/radioslam}
if [[ -x $program ]]; then
  refuse_in "radioslam --help" < <("$program" --help)
  while read -r command; do
    refuse_in "radioslam $command --help" < <("$program" "$command" --help)
  done < <("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/\1/p')
  while read -r kind; do
    refuse_in "radioslam import $kind --help" < <("$program" import "$kind" --help)
  done < <("$program" import --help | sed -n '/^Kinds of source:/,/^$/s/^  \([a-z-]\+\) .*/\1/p')
  for set in run carpark city corridors csi hall kitti optimize similarity aoa anchors; do
    refuse_in "radioslam parameters $set" < <("$program" parameters "$set")
  done
fi
exit "$status"
