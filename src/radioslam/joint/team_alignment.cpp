#include "radioslam/joint/team_alignment.hpp"

#include <algorithm>

#include "radioslam/joint/links/link_weights.hpp"

namespace radioslam {
namespace {

constexpr double kMinAlternative = 0.001;  // min. weight of a reported hypothesis
constexpr std::size_t kMaxAlternatives = 15;

/// A robot belongs to the component of its longest segment.
template <class Pose>
std::vector<int> robot_components(const JointGraph<Pose>& joint, const TeamComponents& components) {
  std::vector<int> result(joint.robots.size(), -1);
  std::vector<std::size_t> longest(joint.robots.size(), 0);
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const std::size_t r = joint.robot_of_segment[p];
    if (joint.team.segments[p].pose_count <= longest[r]) continue;
    longest[r] = joint.team.segments[p].pose_count;
    result[r] = components.of_segment[p];
  }
  return result;
}

/// A robot is unplaced if it is alone in a component other than the first robot's and not in the common
/// frame.
std::vector<bool> placed_robots(const std::vector<int>& component, const std::vector<bool>& absolute) {
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

template <class Pose>
void remember_component(TeamAlignment<Pose>& alignment) {
  alignment.without_matches = alignment.component;
  for (const int c : alignment.component)
    alignment.in_common_frame.push_back(alignment.absolute[static_cast<std::size_t>(c)]);
}

}  // namespace

std::vector<int> renumber_components(std::vector<int>& component_of_robot) {
  std::vector<int> number;
  int next = 0;
  for (int& c : component_of_robot) {
    if (static_cast<std::size_t>(c) >= number.size()) number.resize(static_cast<std::size_t>(c) + 1, -1);
    int& n = number[static_cast<std::size_t>(c)];
    if (n < 0) n = next++;
    c = n;
  }
  return number;
}

template <class Pose>
bool has_radio_links(const JointGraph<Pose>& joint) {
  return !joint.team.graph.ranges.empty() || !joint.team.bearings.empty() ||
         !joint.team.graph.relative_points.empty();
}

template <class Pose>
void set_alternatives(TeamAlignment<Pose>& alignment, const std::vector<TeamHypothesis<Pose>>& hypotheses) {
  alignment.weight = hypotheses.front().weight;
  alignment.alternatives.clear();
  alignment.alternative_weights.clear();
  for (std::size_t k = 1; k < std::min(hypotheses.size(), kMaxAlternatives + 1); ++k) {
    if (hypotheses[k].weight < kMinAlternative) break;
    alignment.alternatives.push_back(hypotheses[k].poses);
    alignment.alternative_weights.push_back(hypotheses[k].weight);
  }
}

template <class Pose>
TeamAlignment<Pose> align_by_links(JointGraph<Pose>& joint, const RadioAlignmentParams& params,
                                   const Progress& progress) {
  const RadioAlignment<Pose> found = align_by_radio(joint.team, params, progress);
  TeamAlignment<Pose> alignment;
  alignment.component = robot_components(joint, found.components);
  const std::vector<int> number = renumber_components(alignment.component);
  alignment.absolute = absolute_components(joint, alignment.component);
  for (const auto& position : joint.team.graph.positions) {
    if (position.i.pose.valid()) continue;
    const int c = found.components.of_point[position.i.point.index()];
    const bool has_robot =
        c >= 0 && static_cast<std::size_t>(c) < number.size() && number[static_cast<std::size_t>(c)] >= 0;
    if (has_robot) alignment.absolute[static_cast<std::size_t>(number[static_cast<std::size_t>(c)])] = true;
  }
  alignment.placed = placed_robots(alignment.component, alignment.absolute);
  adopt_alignment(joint, found.hypotheses.front());
  set_alternatives(alignment, found.hypotheses);
  alignment.segments = found.components;
  remember_component(alignment);
  return alignment;
}

template <class Pose>
TeamAlignment<Pose> align_robots_by_fingerprints(JointGraph<Pose>& joint, const Mission& mission,
                                                 const KnownStarts& starts, const RadioMeasurements& radio,
                                                 const LayoutParams& params, const Progress& progress) {
  const TeamFrame frame = align_by_fingerprints(mission, starts, radio, params, progress);
  place_robots(joint, frame.T_team_start);
  TeamAlignment<Pose> alignment;
  alignment.component = frame.component;
  alignment.placed = frame.placed;
  alignment.absolute = absolute_components(joint, frame.component);
  remember_component(alignment);
  return alignment;
}

#define RADIOSLAM_TEAM_ALIGNMENT(Pose)                                                                    \
  template void set_alternatives(TeamAlignment<Pose>&, const std::vector<TeamHypothesis<Pose>>&);         \
  template bool has_radio_links(const JointGraph<Pose>&);                                                 \
  template TeamAlignment<Pose> align_by_links(JointGraph<Pose>&, const RadioAlignmentParams&,             \
                                              const Progress&);                                           \
  template TeamAlignment<Pose> align_robots_by_fingerprints(JointGraph<Pose>&, const Mission&,            \
                                                            const KnownStarts&, const RadioMeasurements&, \
                                                            const LayoutParams&, const Progress&);
RADIOSLAM_TEAM_ALIGNMENT(SE2)
RADIOSLAM_TEAM_ALIGNMENT(SE3)
#undef RADIOSLAM_TEAM_ALIGNMENT

}  // namespace radioslam
