#include "radioslam/pipeline/team_placement.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/team_frame/level_priors.hpp"

namespace radioslam {
namespace {

constexpr double kLeastWeight = 0.05;        // of a path or range that takes part in the final solution
constexpr double kSaysNothing_rad = 0.5;     // an angle between robots this close, for their antennas' places
constexpr double kLeastAlternative = 0.001;  // of a hypothesis worth writing
constexpr std::size_t kMostAlternatives = 3;

template <class Pose>
void adopt(JointGraph<Pose>& joint, const TeamHypothesis<Pose>& hypothesis) {
  auto& graph = joint.team.graph;
  graph.poses = hypothesis.poses;
  graph.points = hypothesis.points;
  graph.drifts = hypothesis.drifts;
  turn_level_priors(graph);
  for (std::size_t k = 0; k < hypothesis.range_weight.size(); ++k)
    graph.ranges[k].weight = hypothesis.range_weight[k] < kLeastWeight ? 0 : hypothesis.range_weight[k];
  for (std::size_t k = 0; k < joint.team.bearings.size(); ++k) {
    const auto& bearing = joint.team.bearings[k];
    BearingVerdict& verdict = joint.bearing_verdicts.emplace_back();
    for (std::size_t p = 0; p < bearing.paths.size(); ++p) {
      const double weight = hypothesis.path_weight[k][p];
      const double by_places2 =
          std::pow(hypothesis.path_sigma_rad[k][p], 2) - std::pow(bearing.paths[p].sigma_rad, 2);
      if (by_places2 > kSaysNothing_rad * kSaysNothing_rad) verdict.too_near = true;
      if (weight < kLeastWeight || verdict.too_near) continue;
      verdict.weight += weight;
      graph.bearings.push_back(
          {bearing.i, bearing.j, bearing.paths[p].direction, hypothesis.path_sigma_rad[k][p], {}, weight});
    }
  }
}

/// A robot's component is that of its longest piece.
template <class Pose>
std::vector<int> robot_components(const JointGraph<Pose>& joint, const TeamComponents& components) {
  std::vector<int> result(joint.robots.size(), -1);
  std::vector<std::size_t> longest(joint.robots.size(), 0);
  for (std::size_t p = 0; p < joint.team.pieces.size(); ++p) {
    const std::size_t r = joint.robot_of_piece[p];
    if (joint.team.pieces[p].pose_count <= longest[r]) continue;
    longest[r] = joint.team.pieces[p].pose_count;
    result[r] = components.of_piece[p];
  }
  return result;
}

/// Numbers in the order of the robots, without gaps; returns the number of every old one.
std::vector<int> renumber(std::vector<int>& components) {
  std::vector<int> number;
  int next = 0;
  for (int& c : components) {
    if (static_cast<std::size_t>(c) >= number.size()) number.resize(static_cast<std::size_t>(c) + 1, -1);
    int& n = number[static_cast<std::size_t>(c)];
    if (n < 0) n = next++;
    c = n;
  }
  return number;
}

/// Alone in a component that is not the first robot's means that nothing ties the robot to anybody.
std::vector<bool> tied_robots(const std::vector<int>& component, const std::vector<bool>& absolute) {
  std::vector<bool> placed;
  for (const int c : component)
    placed.push_back(c == 0 || absolute[static_cast<std::size_t>(c)] ||
                     std::count(component.begin(), component.end(), c) > 1);
  return placed;
}

template <class Pose>
std::vector<bool> absolute_components(const JointGraph<Pose>& joint, const std::vector<int>& component) {
  std::vector<bool> absolute(component.size(), false);
  for (std::size_t r = 0; r < component.size(); ++r)
    if (joint.robots[r].T_common_start || joint.robots[r].placed_by_fixes)
      absolute[static_cast<std::size_t>(component[r])] = true;
  return absolute;
}

}  // namespace

template <class Pose>
bool has_radio_links(const JointGraph<Pose>& joint) {
  return !joint.team.graph.ranges.empty() || !joint.team.bearings.empty() ||
         !joint.team.graph.relative_points.empty();
}

template <class Pose>
TeamPlacement<Pose> place_by_radio(JointGraph<Pose>& joint, const RadioAlignmentParams& params,
                                   const Progress& progress) {
  const RadioAlignment<Pose> alignment = align_by_radio(joint.team, params, progress);
  TeamPlacement<Pose> placement;
  placement.component = robot_components(joint, alignment.components);
  const std::vector<int> number = renumber(placement.component);
  placement.absolute = absolute_components(joint, placement.component);
  for (const auto& position : joint.team.graph.positions) {
    if (position.i.pose.valid()) continue;
    const int c = alignment.components.of_point[position.i.point.index()];
    const bool has_robot =
        c >= 0 && static_cast<std::size_t>(c) < number.size() && number[static_cast<std::size_t>(c)] >= 0;
    if (has_robot) placement.absolute[static_cast<std::size_t>(number[static_cast<std::size_t>(c)])] = true;
  }
  placement.placed = tied_robots(placement.component, placement.absolute);
  adopt(joint, alignment.hypotheses.front());
  placement.weight = alignment.hypotheses.front().weight;
  for (std::size_t k = 1; k < std::min(alignment.hypotheses.size(), kMostAlternatives + 1); ++k) {
    if (alignment.hypotheses[k].weight < kLeastAlternative) break;
    placement.alternatives.push_back(alignment.hypotheses[k].poses);
    placement.alternative_weights.push_back(alignment.hypotheses[k].weight);
  }
  return placement;
}

template <class Pose>
TeamPlacement<Pose> place_by_fingerprints(JointGraph<Pose>& joint, const Mission& mission,
                                          const RadioMeasurements& radio, const LayoutParams& params,
                                          const Progress& progress) {
  const TeamFrame frame = align_by_fingerprints(mission, radio, params, progress);
  place_robots(joint, frame.T_team_start);
  TeamPlacement<Pose> placement;
  placement.component = frame.component;
  placement.placed = frame.placed;
  placement.absolute = absolute_components(joint, frame.component);
  return placement;
}

#define RADIOSLAM_PLACEMENT(Pose)                                                             \
  template bool has_radio_links(const JointGraph<Pose>&);                                     \
  template TeamPlacement<Pose> place_by_radio(JointGraph<Pose>&, const RadioAlignmentParams&, \
                                              const Progress&);                               \
  template TeamPlacement<Pose> place_by_fingerprints(                                         \
      JointGraph<Pose>&, const Mission&, const RadioMeasurements&, const LayoutParams&, const Progress&);
RADIOSLAM_PLACEMENT(SE2)
RADIOSLAM_PLACEMENT(SE3)
#undef RADIOSLAM_PLACEMENT

}  // namespace radioslam
