#include "radioslam/joint/links/link_weights.hpp"

#include <cmath>
#include <map>

namespace radioslam {
namespace {

constexpr double kMinWeight = 0.05;  // min. weight of a path or range in the final solution
constexpr double kMaxSigmaByPositions_rad =
    0.5;  // direction error from antenna positions above which an angle is unused

}  // namespace

template <class Pose>
TeamGraph<Pose> radio_team(const JointGraph<Pose>& joint) {
  TeamGraph<Pose> team = joint.team;
  team.graph.bearings.clear();
  team.graph.ranges.clear();
  for (const std::size_t k : factors_of(joint.origins.ranges, FactorSource::kRange))
    team.graph.ranges.push_back(joint.team.graph.ranges[k]);
  return team;
}

template <class Pose>
void adopt_alignment(JointGraph<Pose>& joint, const TeamHypothesis<Pose>& hypothesis) {
  auto& graph = joint.team.graph;
  graph.bearings.clear();
  joint.bearing_weights.clear();
  graph.poses = hypothesis.poses;
  graph.points = hypothesis.points;
  graph.drifts = hypothesis.drifts;
  const auto ranges = factors_of(joint.origins.ranges, FactorSource::kRange);
  for (std::size_t k = 0; k < ranges.size(); ++k)
    graph.ranges[ranges[k]].weight = hypothesis.range_weight[k] < kMinWeight ? 0 : hypothesis.range_weight[k];
  for (std::size_t k = 0; k < joint.team.bearings.size(); ++k) {
    const auto& bearing = joint.team.bearings[k];
    BearingWeight& bearing_weight = joint.bearing_weights.emplace_back();
    bearing_weight.paths = hypothesis.path_weight[k];
    for (std::size_t p = 0; p < bearing.paths.size(); ++p) {
      const double weight = hypothesis.path_weight[k][p];
      const double by_positions2 =
          std::pow(hypothesis.path_sigma_rad[k][p], 2) - std::pow(bearing.paths[p].sigma_rad, 2);
      if (by_positions2 > kMaxSigmaByPositions_rad * kMaxSigmaByPositions_rad) bearing_weight.too_near = true;
      if (weight < kMinWeight || bearing_weight.too_near) continue;
      bearing_weight.weight += weight;
      BearingFactor<Pose>& factor = graph.bearings.emplace_back(path_factor(bearing, p));
      factor.sigma_rad = hypothesis.path_sigma_rad[k][p];
      factor.weight = weight;
    }
  }
}

template <class Pose>
double reweigh_radio_links(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                           const MixtureParams& params) {
  const TeamHypothesis<Pose> weighed = weigh_links(radio_team(joint), alignment.segments, params);
  adopt_alignment(joint, weighed);
  return weighed.log_evidence;
}

template <class Pose>
void silence_links(JointGraph<Pose>& joint, const PairsOfRobots& pairs) {
  auto& graph = joint.team.graph;
  const auto is_of_a_pair = [&](RobotIndex i, RobotIndex j) {
    return i.valid() && j.valid() && pairs.contains(std::minmax(i, j));
  };
  for (std::size_t k = 0; k < graph.ranges.size(); ++k) {
    const FactorOrigin& origin = joint.origins.ranges[k];
    if (origin.source == FactorSource::kRange && is_of_a_pair(origin.robot_i, origin.robot_j))
      graph.ranges[k].weight = 0;
  }
  std::map<std::int32_t, RobotIndex> robot_of_pose;
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p)
    for (std::size_t k = 0; k < joint.team.segments[p].pose_count; ++k)
      robot_of_pose[PoseId(joint.team.segments[p].first_pose + k).value] =
          RobotIndex(joint.robot_of_segment[p]);
  for (auto& bearing : graph.bearings)
    if (bearing.j.pose.valid() &&
        is_of_a_pair(robot_of_pose.at(bearing.i.value), robot_of_pose.at(bearing.j.pose.value)))
      bearing.weight = 0;
}

#define RADIOSLAM_LINK_WEIGHTS(Pose)                                                                        \
  template TeamGraph<Pose> radio_team(const JointGraph<Pose>&);                                             \
  template void adopt_alignment(JointGraph<Pose>&, const TeamHypothesis<Pose>&);                            \
  template double reweigh_radio_links(JointGraph<Pose>&, const TeamAlignment<Pose>&, const MixtureParams&); \
  template void silence_links(JointGraph<Pose>&, const PairsOfRobots&);
RADIOSLAM_LINK_WEIGHTS(SE2)
RADIOSLAM_LINK_WEIGHTS(SE3)
#undef RADIOSLAM_LINK_WEIGHTS

}  // namespace radioslam
