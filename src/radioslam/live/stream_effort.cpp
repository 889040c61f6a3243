#include "radioslam/live/stream_effort.hpp"

#include <algorithm>

namespace radioslam {
namespace {

constexpr double kPeriod_s = 1, kJudgePeriod_s = 10, kContradictedPeriod_s = 3;
constexpr double kSecondsPerKeyframe = 6e-6;  // of an extension
constexpr double kJudgedGrowth = 1.25;        // of what is known
constexpr std::size_t kFewLinks = 4;          // that may relate two frames; half as many more may do so again
constexpr double kSearchedGrowth = 1.5, kSearchedTime = 1.2;
constexpr double kCertain = 0.99;

bool has_grown(std::size_t now, std::size_t before, double by) {
  return static_cast<double>(now) > by * static_cast<double>(before);
}

/// Whether a search over all alignments may say more than the last one.
bool needs_search(const EffortState& state, const KnownCounts& known) {
  if (!state.aligned) return true;
  const KnownCounts& before = state.aligned->known;
  const auto enough =
      std::max({kFewLinks, before.unjoined_links + kFewLinks / 2,
                static_cast<std::size_t>(kSearchedGrowth * static_cast<double>(before.unjoined_links))});
  return known.unjoined_links >= enough ||
         (state.weight < kCertain && has_grown(known.links, before.links, kSearchedGrowth)) ||
         (state.is_contradicted && state.last != Effort::kExtend);
}

bool needs_judgement(const EffortState& state, const KnownCounts& known) {
  if (!state.judged) return true;
  const KnownCounts& before = state.judged->known;
  return has_grown(known.keyframes, before.keyframes, kJudgedGrowth) ||
         has_grown(known.links, before.links, kJudgedGrowth) ||
         has_grown(known.fingerprints, before.fingerprints, kJudgedGrowth) ||
         has_grown(known.closures, before.closures, kJudgedGrowth);
}

}  // namespace

void EffortState::note(Effort effort, Stamp at, const KnownCounts& known) {
  any = {at, known};
  last = effort;
  if (effort == Effort::kExtend) return;
  judged = any;
  if (effort == Effort::kAlign) aligned = any;
}

std::optional<Effort> due_effort(const EffortState& state, Stamp now, const KnownCounts& known,
                                 const StreamParams& params) {
  if (!state.any) return Effort::kAlign;
  const double since_s = seconds_between(state.any->at, now);
  if (since_s < kPeriod_s || known.records == state.any->known.records) return std::nullopt;
  const double since_search_s = seconds_between(state.aligned->at, now);
  if (needs_search(state, known) && since_search_s >= kJudgePeriod_s &&
      seconds_between(state.begin, now) >= kSearchedTime * seconds_between(state.begin, state.aligned->at))
    return Effort::kAlign;
  const double since_judgement_s = seconds_between(state.judged->at, now);
  if ((needs_judgement(state, known) && since_judgement_s >= kJudgePeriod_s) ||
      (state.is_contradicted && since_judgement_s >= kContradictedPeriod_s))
    return known.unjoined_links >= kFewLinks / 2 || state.weight < kCertain ? Effort::kAlign : Effort::kJudge;
  const double nominal_s = kSecondsPerKeyframe * static_cast<double>(known.keyframes);
  if (since_s * params.work_share < nominal_s) return std::nullopt;
  return Effort::kExtend;
}

}  // namespace radioslam
