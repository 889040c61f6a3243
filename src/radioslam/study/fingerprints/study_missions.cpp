#include "radioslam/study/fingerprints/study_missions.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/geometry/alignment.hpp"
#include "radioslam/study/fingerprints/fingerprint_tables.hpp"

namespace radioslam {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Trajectory<SE3> moved(const Trajectory<SE3>& trajectory, const SE3& T_to_from) {
  std::vector<StampedPose<SE3>> poses(trajectory.begin(), trajectory.end());
  for (auto& row : poses) row.pose = T_to_from * row.pose;
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace

std::string StudyMission::name() const { return seed ? std::to_string(*seed) : mission.name; }

std::vector<StudyMission> simulated_carparks(const CarparkParams& carpark, std::uint64_t first_seed,
                                             int seeds) {
  std::vector<StudyMission> missions;
  for (int k = 0; k < seeds; ++k) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(k);
    auto [mission, truth] = simulate_carpark(carpark, seed);
    missions.push_back({std::move(mission), std::move(truth), seed});
  }
  return missions;
}

std::string listed(const std::vector<StudyMission>& missions) {
  std::vector<std::string> names;
  for (const StudyMission& mission : missions) names.push_back(mission.name());
  const bool is_one = names.size() == 1;
  if (missions.empty() || !missions.front().seed) return (is_one ? "Mission " : "Missions ") + joined(names);
  return is_one ? "Seed " + names.front()
                : std::to_string(names.size()) + " seeds from " + names.front() + " on";
}

std::optional<std::string> lacking(const StudyMission& mission) {
  const auto& robots = mission.mission.robots;
  if (mission.mission.dimension != 2) return "mission.yaml: needs dimension: 2";
  for (const Robot& robot : robots)
    if (robot.odometry.empty()) return "robots/" + robot.id + "/odometry.tum: needed";
  if (std::all_of(robots.begin(), robots.end(), [](const Robot& robot) { return robot.wifi.empty(); }))
    return "robots/<id>/wifi.csv: needed, as the closures are those of fingerprints";
  if (mission.truth.empty()) return "robots/<id>/groundtruth.tum: needed to compare with";
  return std::nullopt;
}

void take_starts_of_truth(StudyMission& mission) {
  for (std::size_t r = 0; r < mission.mission.robots.size(); ++r) {
    Robot& robot = mission.mission.robots[r];
    if (robot.initial_pose || robot.odometry.empty()) continue;
    std::vector<Eigen::Vector2d> from, to;
    for (const auto& [stamp, pose] : mission.truth.robots[r].poses)
      if (const auto odometry = robot.odometry.at(stamp)) {
        from.push_back(odometry->translation().head<2>());
        to.push_back(pose.translation().head<2>());
      }
    if (from.size() < 2) continue;
    const auto columns = [](const std::vector<Eigen::Vector2d>& points) -> Eigen::Matrix2Xd {
      return Eigen::Map<const Eigen::Matrix2Xd>(points.front().data(), 2,
                                                static_cast<Eigen::Index>(points.size()));
    };
    const SE2 T_common_odometry = align_points(columns(from), columns(to));
    const SE2 start = flatten(robot.odometry.front().pose);
    robot.initial_pose = lift(T_common_odometry * start);
    robot.odometry = moved(robot.odometry, lift(start.inverse()));
    ++mission.starts_of_truth;
  }
}

std::string of_unknown_start(const Mission& mission) {
  std::vector<std::string> names;
  for (const Robot& robot : mission.robots)
    if (!robot.initial_pose) names.push_back(robot.id);
  return joined(names);
}

std::vector<std::string> similarity_measures() {
  std::vector<std::string> names;
  for (const FingerprintMeasure& measure : kFingerprintMeasures)
    if (names.empty() || names.back() != measure.measure) names.emplace_back(measure.measure);
  return names;
}

}  // namespace radioslam
