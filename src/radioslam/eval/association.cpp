#include "radioslam/eval/association.hpp"

#include <algorithm>
#include <cmath>

namespace radioslam {
namespace {

/// Index of the pose with the nearest stamp; the earlier of two equally near. Needs one pose.
std::size_t nearest(const Trajectory<SE3>& trajectory, Stamp stamp) {
  if (trajectory.size() == 1) return 0;
  const std::size_t i = trajectory.segment(stamp);
  return std::abs(seconds_between(trajectory[i + 1].stamp, stamp)) <
                 std::abs(seconds_between(trajectory[i].stamp, stamp))
             ? i + 1
             : i;
}

/// Index pairs (shorter, longer) of agreeing stamps.
std::vector<std::pair<std::size_t, std::size_t>> agreeing_stamps(const Trajectory<SE3>& shorter,
                                                                 const Trajectory<SE3>& longer) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t k = nearest(longer, shorter[i].stamp);
    if (std::abs(seconds_between(longer[k].stamp, shorter[i].stamp)) <= kNearestStampDifference_s)
      pairs.emplace_back(i, k);
  }
  return pairs;
}

std::vector<MatchedPose> match_nearest(const Trajectory<SE3>& estimate, const Trajectory<SE3>& truth) {
  std::vector<MatchedPose> matched;
  if (estimate.empty() || truth.empty()) return matched;
  const bool truth_is_shorter = truth.size() < estimate.size();
  const auto pairs = truth_is_shorter ? agreeing_stamps(truth, estimate) : agreeing_stamps(estimate, truth);
  for (const auto& [i, k] : pairs) {
    const std::size_t in_truth = truth_is_shorter ? i : k;
    const std::size_t in_estimate = truth_is_shorter ? k : i;
    matched.push_back({in_truth, truth[in_truth].pose, estimate[in_estimate].pose});
  }
  return matched;
}

}  // namespace

std::optional<SE3> pose_at(const Trajectory<SE3>& trajectory, Stamp stamp) {
  if (!trajectory.covers(stamp)) return std::nullopt;
  if (trajectory.size() == 1) return trajectory.front().pose;
  const std::size_t i = trajectory.segment(stamp);
  const auto& a = trajectory[i];
  const auto& b = trajectory[i + 1];
  const double share = seconds_between(a.stamp, stamp) / seconds_between(a.stamp, b.stamp);
  return SE3(a.pose.translation() + share * (b.pose.translation() - a.pose.translation()),
             a.pose.rotation().slerp(share, b.pose.rotation()));
}

std::optional<SE3> pose_near(const Trajectory<SE3>& trajectory, Stamp stamp, double slack_s) {
  if (trajectory.empty()) return std::nullopt;
  const Stamp clamped = std::clamp(stamp, trajectory.front().stamp, trajectory.back().stamp);
  if (std::abs(seconds_between(clamped, stamp)) > slack_s) return std::nullopt;
  return pose_at(trajectory, clamped);
}

std::vector<MatchedPose> match_poses(const Trajectory<SE3>& estimate, const RobotTruth& truth,
                                     Association association) {
  if (association == Association::kNearest) return match_nearest(estimate, truth.poses);
  const double slack_s = truth.has_orientation ? 0 : kWaypointStampSlack_s;
  std::vector<MatchedPose> matched;
  for (std::size_t i = 0; i < truth.poses.size(); ++i)
    if (const auto pose = pose_near(estimate, truth.poses[i].stamp, slack_s))
      matched.push_back({i, truth.poses[i].pose, *pose});
  return matched;
}

}  // namespace radioslam
