#include "radioslam/study/wi_closure_hall/hall_truth.hpp"

#include <algorithm>

#include "radioslam/eval/association.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/mission/keyframes.hpp"

namespace radioslam {
namespace {

/// Whether the measured relative pose is near the true one; nothing where the truth does not cover it.
std::optional<bool> is_true_place(const ClosureResult& closure, const Truth& truth, int dimension) {
  const auto i = pose_at(truth.robots[closure.robot_i.index()].poses, closure.stamp_i);
  const auto j = pose_at(truth.robots[closure.robot_j.index()].poses, closure.stamp_j);
  if (!closure.T_i_j || !i || !j) return std::nullopt;
  SE3 error = closure.T_i_j->inverse() * i->inverse() * *j;
  if (dimension == 2) error = lift(flatten(error));
  return error.translation().norm() <= kTruePlace_m && so3_log(error.rotation()).norm() <= kTruePlace_rad;
}

/// Takes the closure of an angle out of `closures`, which are those of angles; null if there is none.
const ClosureResult* take_closure(std::vector<const ClosureResult*>& closures, const AoaMeasurement& angle,
                                  const RunResult& result) {
  const auto is_at = [&](RobotIndex robot, Stamp keyframe) {
    std::vector<Stamp> stamps;
    for (const auto& pose : result.robots[robot.index()].estimate) stamps.push_back(pose.stamp);
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

PlaceClosures count_place_closures(const RunResult& result, const Truth& truth) {
  PlaceClosures counts;
  for (const ClosureResult& closure : result.closures) {
    if (closure.kind != ClosureKind::kLidar || closure.robot_i == closure.robot_j) continue;
    if (closure.status != ClosureStatus::kAccepted) continue;
    const auto is_true = is_true_place(closure, truth, result.dimension);
    if (!is_true) continue;
    ++counts.accepted;
    if (*is_true) ++counts.true_accepted;
  }
  return counts;
}

std::optional<std::size_t> AnglePaths::likeliest() const {
  if (weights.empty()) return std::nullopt;
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

bool AnglePaths::finds_direct() const {
  const auto path = likeliest();
  return accepted && path && has_direct() && static_cast<int>(*path) == *direct_path;
}

std::vector<AnglePaths> judge_angle_paths(const RunResult& result, const Mission& mission,
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
