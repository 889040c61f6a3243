#include "radioslam/joint/robot_nodes.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"

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

}  // namespace

std::size_t RobotNodes::node_at(Stamp stamp) const {
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  RADIOSLAM_CHECK(found != stamps.end() && *found == stamp, "every link within the odometry has a node");
  return static_cast<std::size_t>(found - stamps.begin());
}

RobotNodes nodes_at(const Trajectory<SE3>& odometry, std::vector<Stamp> stamps) {
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  RobotNodes nodes;
  nodes.odometry = with_stamps(odometry, stamps);
  nodes.stamps = std::move(stamps);
  for (std::size_t row = 0, n = 0; n < nodes.stamps.size(); ++row)
    if (nodes.odometry[row].stamp == nodes.stamps[n]) nodes.rows.push_back(row), ++n;
  return nodes;
}

RobotNodes select_nodes(const Trajectory<SE3>& odometry, std::vector<Stamp> node_stamps,
                        const KeyframeParams& params) {
  std::erase_if(node_stamps, [&](Stamp node_stamp) { return !odometry.covers(node_stamp); });
  std::vector<Stamp> keyframes;
  for (const std::size_t row : refined_keyframes(odometry, select_keyframes(odometry, params), params))
    keyframes.push_back(odometry[row].stamp);
  node_stamps.insert(node_stamps.end(), keyframes.begin(), keyframes.end());
  RobotNodes nodes = nodes_at(odometry, std::move(node_stamps));
  for (const Stamp keyframe : keyframes) nodes.keyframes.push_back(nodes.node_at(keyframe));
  return nodes;
}

}  // namespace radioslam
