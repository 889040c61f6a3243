#include "radioslam/study/wi_closure/place_truth.hpp"

#include <optional>

#include "radioslam/eval/association.hpp"
#include "radioslam/geometry/so3.hpp"

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

}  // namespace radioslam
