#include "radioslam/live/growing_estimate.hpp"

#include <stdexcept>
#include <utility>
#include <variant>

#include "radioslam/live/link_evidence.hpp"

namespace radioslam {

template <class Pose>
void GrowingEstimate<Pose>::hear(const std::string& robot, Record record, Stamp now) {
  if (known_.records++ == 0) state_.begin = now;
  count(keyframes_[robot], record);
  logs_.add(robot, std::move(record));
}

template <class Pose>
void GrowingEstimate<Pose>::count(LoggedKeyframes& robot, const Record& record) {
  if (const auto* keyframe = std::get_if<KeyframeRecord>(&record)) {
    ++known_.keyframes;
    robot.add(*keyframe);
  } else if (const auto* amendment = std::get_if<AmendmentRecord>(&record)) {
    robot.add(*amendment);
  } else if (std::holds_alternative<RangeRecord>(record) || std::holds_alternative<AnglesRecord>(record)) {
    ++known_.links;
  } else if (std::holds_alternative<FingerprintRecord>(record)) {
    ++known_.fingerprints;
  } else if (std::holds_alternative<ClosureRecord>(record)) {
    ++known_.closures;
  }
}

template <class Pose>
std::optional<EstimateRequest<Pose>> GrowingEstimate<Pose>::request(Stamp now) {
  if (seconds_between(considered_, now) < 1 && state_.any) return std::nullopt;
  considered_ = now;
  if (!due_effort(state_, now, known_, stream_)) return std::nullopt;
  return EstimateRequest<Pose>{logs_, known_, state_, stream_, last_, now};
}

template <class Pose>
void GrowingEstimate<Pose>::take(GrownEstimate<Pose> estimate) {
  known_.unjoined_links = estimate.known.unjoined_links;
  if (!estimate.solution) return;
  last_ = std::move(estimate.solution);
  state_.weight = last_->weight_by_links;
  state_.is_contradicted = fits_worse_of_late(last_->team);
  state_.note(last_->effort, estimate.at, estimate.known);
}

template <class Pose>
GrownEstimate<Pose> estimate(const EstimateRequest<Pose>& request, const RunParams& params,
                             const std::function<MeasuredScans(const LoggedMission&)>& scans_of) {
  GrownEstimate<Pose> grown{request.known, request.at, nullptr};
  LoggedMission logged;
  try {
    logged = request.logs.mission();
  } catch (const std::runtime_error&) {  // no robot has moved yet
    return grown;
  }
  const TeamSolution<Pose>* last = request.last.get();
  grown.known.unjoined_links = unjoined_links(logged.mission, last ? &last->team : nullptr);
  const auto effort = due_effort(request.state, request.at, grown.known, request.stream);
  if (!effort) return grown;
  const MeasuredScans scans = scans_of && *effort != Effort::kExtend ? scans_of(logged) : MeasuredScans{};
  grown.solution = std::make_shared<const TeamSolution<Pose>>(
      estimate<Pose>(TeamView{logged, scans}, last, *effort, params, {.lists_overlaps = false}));
  return grown;
}

#define RADIOSLAM_GROWING(Pose)                                                         \
  template class GrowingEstimate<Pose>;                                                 \
  template GrownEstimate<Pose> estimate(const EstimateRequest<Pose>&, const RunParams&, \
                                        const std::function<MeasuredScans(const LoggedMission&)>&);
RADIOSLAM_GROWING(SE2)
RADIOSLAM_GROWING(SE3)
#undef RADIOSLAM_GROWING

}  // namespace radioslam
