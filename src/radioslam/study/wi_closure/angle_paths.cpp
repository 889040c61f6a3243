#include "radioslam/study/wi_closure/angle_paths.hpp"

#include <algorithm>

#include "radioslam/mission/keyframes.hpp"

namespace radioslam {
namespace {

/// Takes the closure of an angle out of `closures`, which are those of angles; null if there is none.
const ClosureResult* take_closure(std::vector<const ClosureResult*>& closures, const AoaMeasurement& angle,
                                  const RunResult& result) {
  const auto is_at = [&](RobotIndex robot, Stamp keyframe) {
    const std::vector<Stamp> stamps = result.robots[robot.index()].estimate.stamps();
    return !stamps.empty() && stamps[keyframe_before(stamps, angle.stamp)] == keyframe;
  };
  const auto found = std::find_if(closures.begin(), closures.end(), [&](const ClosureResult* closure) {
    return closure->robot_i == angle.receiver && closure->robot_j == angle.transmitter.robot &&
           is_at(closure->robot_i, closure->stamp_i) && is_at(closure->robot_j, closure->stamp_j);
  });
  if (found == closures.end()) return nullptr;
  const ClosureResult* closure = *found;
  closures.erase(found);
  return closure;
}

}  // namespace

std::optional<std::size_t> AnglePaths::likeliest() const {
  if (weights.empty()) return std::nullopt;
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

bool AnglePaths::finds_direct() const {
  const auto path = likeliest();
  return accepted && path && has_direct() && static_cast<int>(*path) == *direct_path;
}

std::vector<AnglePaths> compare_angle_paths(const RunResult& result, const Mission& mission,
                                            const Truth& truth) {
  std::vector<const ClosureResult*> closures;
  for (const ClosureResult& closure : result.closures)
    if (closure.kind == ClosureKind::kAoa) closures.push_back(&closure);
  std::vector<AnglePaths> angles;
  for (std::size_t k = 0; k < mission.aoa_measurements.size(); ++k) {
    const AoaMeasurement& measured = mission.aoa_measurements[k];
    if (!measured.transmitter.robot.valid()) continue;
    AnglePaths& angle = angles.emplace_back();
    angle.paths = measured.paths.size();
    if (k < truth.direct_paths.size()) angle.direct_path = truth.direct_paths[k];
    if (const ClosureResult* closure = take_closure(closures, measured, result)) {
      angle.weights = closure->path_weights;
      angle.accepted = closure->status == ClosureStatus::kAccepted;
    }
  }
  return angles;
}

}  // namespace radioslam
