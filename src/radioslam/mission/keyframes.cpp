#include "radioslam/mission/keyframes.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/mission/keyframe_choice.hpp"

namespace radioslam {
namespace {

Trajectory<SE3> with_stamps(const Trajectory<SE3>& odometry, const std::vector<Stamp>& node_stamps) {
  std::vector<StampedPose<SE3>> rows(odometry.begin(), odometry.end());
  for (const Stamp node_stamp : node_stamps) rows.push_back({node_stamp, *odometry.at(node_stamp)});
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp == b.stamp; }),
      rows.end());
  return Trajectory<SE3>(std::move(rows));
}

/// In time order.
std::vector<Occasion> occasions_of(const Mission& mission, RobotIndex robot,
                                   const std::vector<Stamp>& given) {
  std::vector<Occasion> occasions;
  for (const Stamp stamp : given) occasions.push_back({stamp, 0, 0});
  for (const RangeMeasurement& range : mission.ranges)
    if (range.i.robot == robot || range.j.robot == robot) occasions.push_back({range.stamp, range.sigma_m});
  for (const AoaMeasurement& angles : mission.aoa_measurements)
    if (angles.receiver == robot)
      for (const AoaPath& path : angles.paths) occasions.push_back(occasion_of(angles.stamp, path));
  for (const PositionFix& fix : mission.robots[robot.index()].fixes)
    occasions.push_back({fix.stamp, fix.sigma_m});
  for (const PoseMatch& match : mission.matches) {
    if (match.robot_i == robot) occasions.push_back(occasion_of(match.stamp_i, match.covariance));
    if (match.robot_j == robot) occasions.push_back(occasion_of(match.stamp_j, match.covariance));
  }
  std::stable_sort(occasions.begin(), occasions.end(),
                   [](const Occasion& a, const Occasion& b) { return a.stamp < b.stamp; });
  return occasions;
}

}  // namespace

bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params) {
  const SE3 step = last.inverse() * pose;
  return step.translation().norm() >= params.distance_m || step.log().tail<3>().norm() >= params.angle_rad;
}

std::vector<Stamp> choose_keyframes(const Mission& mission, RobotIndex robot, const KeyframeParams& params,
                                    const std::vector<Stamp>& given) {
  const Trajectory<SE3>& odometry = mission.robots[robot.index()].odometry;
  const std::vector<Occasion> occasions = occasions_of(mission, robot, given);
  KeyframeChoice choice(mission.robots[robot.index()], params);
  auto occasion = occasions.begin();
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    choice.add(odometry[i]);
    if (i + 1 == odometry.size()) break;
    for (; occasion != occasions.end() && occasion->stamp < odometry[i + 1].stamp; ++occasion)
      if (odometry[i].stamp <= occasion->stamp) choice.add(*occasion);
  }
  choice.finish();
  return choice.keyframes();
}

std::vector<Stamp> keyframes_of(const Mission& mission, RobotIndex robot, const KeyframeParams& params) {
  const std::vector<Stamp>& chosen = mission.robots[robot.index()].keyframes;
  return chosen.empty() ? choose_keyframes(mission, robot, params) : chosen;
}

RobotNodes nodes_at(const Trajectory<SE3>& odometry, std::vector<Stamp> keyframes) {
  RobotNodes nodes;
  nodes.odometry = with_stamps(odometry, keyframes);
  nodes.stamps = std::move(keyframes);
  for (std::size_t row = 0, n = 0; n < nodes.stamps.size(); ++row)
    if (nodes.odometry[row].stamp == nodes.stamps[n]) nodes.rows.push_back(row), ++n;
  return nodes;
}

std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp) {
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), stamp);
  return after == keyframes.begin() ? 0 : static_cast<std::size_t>(after - keyframes.begin()) - 1;
}

}  // namespace radioslam
