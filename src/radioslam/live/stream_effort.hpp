// When a team's estimate is made again, and with how much effort, as a function of what is known.
//
// Counted, not timed: the same stream has the same estimates on every machine. Judgements and searches follow
// the growth of what is known, so that all of them together cost a few times as much as one of everything.
// Where links lie between frames that are not joined, or leave several alignments, a judgement is a search:
// where places look alike, closures must choose among all of them.
#pragma once

#include <cstddef>
#include <optional>

#include "radioslam/base/stamp.hpp"
#include "radioslam/pipeline/pipeline.hpp"

namespace radioslam {

struct StreamParams {
  double work_share = 0.02;  ///< of the time of one core, for extensions at their nominal cost
};

/// How much is known of a team.
struct KnownCounts {
  std::size_t records = 0, keyframes = 0, links = 0, fingerprints = 0, closures = 0;
  std::size_t unjoined_links = 0;  ///< between the two frames with the most of them
};

/// The estimates so far.
struct EffortState {
  struct Done {
    Stamp at;
    KnownCounts known;
  };
  std::optional<Done> any, judged, aligned;
  Stamp begin;                   ///< of the mission
  double weight = 1;             ///< of the alignment by links
  bool is_contradicted = false;  ///< the last links fit much worse than those before
  Effort last = Effort::kAlign;

  void note(Effort effort, Stamp at, const KnownCounts& known);
};

/// The effort of an estimate that is due now, at most once a second; nothing if none is.
std::optional<Effort> due_effort(const EffortState& state, Stamp now, const KnownCounts& known,
                                 const StreamParams& params);

}  // namespace radioslam
