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
std::optional<DueEstimate> GrowingEstimate<Pose>::due(Stamp now) {
  if (seconds_between(considered_, now) < 1 && state_.any) return std::nullopt;
  considered_ = now;
  if (!due_effort(state_, now, known_, stream_)) return std::nullopt;
  DueEstimate due;
  try {
    due.logged = logs_.mission();
  } catch (const std::runtime_error&) {  // no robot has moved yet
    return std::nullopt;
  }
  known_.unjoined_links = unjoined_links(due.logged.mission, last_ ? &last_->team : nullptr);
  const auto effort = due_effort(state_, now, known_, stream_);
  if (!effort) return std::nullopt;
  due.effort = *effort;
  due.at = now;
  due.known = known_;
  return due;
}

template <class Pose>
void GrowingEstimate<Pose>::take(const DueEstimate& due, Solution solution) {
  last_ = std::move(solution);
  state_.weight = last_->weight_by_links;
  state_.is_contradicted = fits_worse_of_late(last_->team);
  state_.note(last_->effort, due.at, due.known);
}

template class GrowingEstimate<SE2>;
template class GrowingEstimate<SE3>;

}  // namespace radioslam
