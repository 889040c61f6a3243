#include "radioslam/joint/team_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/team_frame/alignment_continuity.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

constexpr double kMinAlternative = 0.001;  // min. weight of a reported hypothesis
constexpr std::size_t kMaxAlternatives = 15;

/// Which of two components a robot with poses in both belongs to: the one that compares as larger.
struct ComponentSize {
  bool is_common = false;  ///< a start in it is known
  std::size_t poses = 0;

  auto operator<=>(const ComponentSize&) const = default;
};

std::vector<ComponentSize> component_sizes(const std::vector<TrajectorySegment>& segments,
                                           const std::vector<int>& of_segment) {
  std::vector<ComponentSize> sizes;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto c = static_cast<std::size_t>(of_segment[s]);
    if (sizes.size() <= c) sizes.resize(c + 1);
    sizes[c].poses += segments[s].pose_count;
    sizes[c].is_common = sizes[c].is_common || segments[s].in_common_frame;
  }
  return sizes;
}

/// The numbers of all components: the robots' as given, the others from there on.
std::vector<int> numbers_beyond(std::vector<int> number, int next) {
  for (int& n : number)
    if (n < 0) n = next++;
  return number;
}

/// Components before the team is aligned: segments whose starts are known share a frame; further segments of
/// a robot have their own.
template <class Pose>
std::vector<int> segments_apart(const JointGraph<Pose>& joint, const std::vector<int>& of_robot) {
  std::vector<int> component;
  std::vector<bool> seen(joint.robots.size(), false);
  std::optional<int> common;
  int next = static_cast<int>(joint.robots.size());
  for (std::size_t s = 0; s < joint.team.segments.size(); ++s) {
    const std::size_t r = joint.robot_of_segment[s];
    component.push_back(seen[r] ? next++ : of_robot[r]);
    seen[r] = true;
    if (!joint.team.segments[s].in_common_frame) continue;
    if (!common) common = component.back();
    component.back() = *common;
  }
  return component;
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

std::string whole_seconds(Stamp stamp) { return std::to_string(std::llround(stamp.seconds())); }

/// Renumbers components without gaps, in the order of the robots; returns the new number of each old one, -1
/// where no robot had it.
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

}  // namespace

template <class Pose>
std::vector<int> set_components(const JointGraph<Pose>& joint, const std::vector<int>& of_segment,
                                TeamAlignment<Pose>& alignment) {
  const std::vector<ComponentSize> sizes = component_sizes(joint.team.segments, of_segment);
  std::vector<int>& component = alignment.component;
  component.assign(joint.robots.size(), -1);
  for (std::size_t s = 0; s < of_segment.size(); ++s) {
    int& of_robot = component[joint.robot_of_segment[s]];
    if (of_robot < 0 ||
        sizes[static_cast<std::size_t>(of_robot)] < sizes[static_cast<std::size_t>(of_segment[s])])
      of_robot = of_segment[s];
  }
  std::vector<int> number = renumber_components(component);
  number.resize(sizes.size(), -1);
  const std::vector<int> all =
      numbers_beyond(number, 1 + *std::max_element(component.begin(), component.end()));
  alignment.of_segment.clear();
  for (const int c : of_segment) alignment.of_segment.push_back(all[static_cast<std::size_t>(c)]);
  return number;
}

template <class Pose>
void set_placed(TeamAlignment<Pose>& alignment) {
  const std::vector<int>& component = alignment.component;
  alignment.placed.clear();
  for (const int c : component)
    alignment.placed.push_back(c == 0 || alignment.absolute[static_cast<std::size_t>(c)] ||
                               std::count(component.begin(), component.end(), c) > 1);
}

template <class Pose>
bool has_untied_poses(const JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment) {
  for (std::size_t s = 0; s < joint.team.segments.size(); ++s)
    if (alignment.of_segment[s] != alignment.component[joint.robot_of_segment[s]]) return true;
  return false;
}

template <class Pose>
void leave_out_untied_poses(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment) {
  if (!has_untied_poses(joint, alignment)) return;
  const auto segment_of = segment_of_poses(joint.team);
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    RobotVariables& robot = joint.robots[r];
    std::size_t kept = 0;
    bool continues = false;
    for (std::size_t k = 0; k < robot.poses.size(); ++k) {
      const bool is_tied = alignment.of_segment[segment_of[robot.poses[k].index()]] == alignment.component[r];
      if (is_tied) {
        robot.stamps[kept] = robot.stamps[k];
        robot.poses[kept] = robot.poses[k];
        robot.odometry[kept++] = robot.odometry[k];
      } else {
        if (!continues) robot.untied.push_back({robot.stamps[k], robot.stamps[k], 0});
        robot.untied.back().last = robot.stamps[k];
        ++robot.untied.back().poses;
      }
      continues = !is_tied;
    }
    robot.stamps.resize(kept);
    robot.poses.resize(kept);
    robot.odometry.resize(kept);
  }
}

std::optional<std::string> untied_note(const std::vector<RobotVariables>& robots) {
  constexpr std::size_t kMaxNamed = 5;
  std::size_t stretches = 0, poses = 0;
  std::string named;
  for (const RobotVariables& robot : robots)
    for (const UntiedStretch& stretch : robot.untied) {
      poses += stretch.poses;
      if (++stretches <= kMaxNamed)
        named += (named.empty() ? "" : ", ") + robot.id +
                 (stretch.poses == 1 ? " at " : " from " + whole_seconds(stretch.first) + " to ") +
                 whole_seconds(stretch.last) + " s";
    }
  if (stretches == 0) return std::nullopt;
  if (stretches > kMaxNamed) named += " and " + std::to_string(stretches - kMaxNamed) + " more";
  return std::to_string(poses) + (poses == 1 ? " pose is" : " poses are") +
         " not placed: behind a gap of the odometry, and no measurement that can be trusted ties the part to "
         "the rest (" +
         named + ")";
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

namespace {

/// Alignments of the team's radio links that are near those known before.
template <class Pose>
RadioAlignment<Pose> refined(const TeamGraph<Pose>& team, const TeamAlignment<Pose>& before,
                             const RadioAlignmentParams& params) {
  std::vector<std::vector<Pose>> starts{team.graph.poses};
  for (std::size_t k = 0; k < before.alternatives.size(); ++k)
    if (before.alternative_weights[k] >= kMinSearchedWeight) starts.push_back(before.alternatives[k]);
  return refine_alignments(team, before.segments, starts, params);
}

template <class Pose>
RadioAlignment<Pose> radio_alignment(const TeamGraph<Pose>& team, const RadioAlignmentParams& params,
                                     const Progress& progress, const TeamAlignment<Pose>* before,
                                     AlignmentSearch search) {
  if (!before || before->segments.of_segment.empty()) return align_by_radio(team, params, progress);
  const RadioAlignment<Pose> as_before{before->segments, {refine_alignment(team, before->segments, params)}};
  return continued(team,
                   search == AlignmentSearch::kAll ? align_by_radio(team, params, progress)
                                                   : refined(team, *before, params),
                   as_before, params);
}

}  // namespace

template <class Pose>
TeamAlignment<Pose> align_by_links(JointGraph<Pose>& joint, const RadioAlignmentParams& params,
                                   const Progress& progress, const TeamAlignment<Pose>* before,
                                   AlignmentSearch search) {
  const RadioAlignment<Pose> found = radio_alignment(joint.team, params, progress, before, search);
  TeamAlignment<Pose> alignment;
  const std::vector<int> number = set_components(joint, found.components.of_segment, alignment);
  alignment.absolute = absolute_components(joint, alignment.component);
  for (const auto& position : joint.team.graph.positions) {
    if (position.i.pose.valid()) continue;
    const int c = found.components.of_point[position.i.point.index()];
    const bool has_robot =
        c >= 0 && static_cast<std::size_t>(c) < number.size() && number[static_cast<std::size_t>(c)] >= 0;
    if (has_robot) alignment.absolute[static_cast<std::size_t>(number[static_cast<std::size_t>(c)])] = true;
  }
  set_placed(alignment);
  adopt_alignment(joint, found.hypotheses.front());
  set_alternatives(alignment, found.hypotheses);
  alignment.segments = found.components;
  remember_component(alignment);
  return alignment;
}

template <class Pose>
TeamAlignment<Pose> align_robots_by_fingerprints(JointGraph<Pose>& joint, const Mission& mission,
                                                 const KnownStarts& starts, const RadioMeasurements& radio,
                                                 const LayoutParams& params, const FieldParams& field,
                                                 const Progress& progress) {
  TeamFrame frame = align_by_fingerprints(mission, starts, radio, params, field, progress);
  place_robots(joint, frame.T_team_start);
  TeamAlignment<Pose> alignment;
  alignment.component = frame.component;
  alignment.placed = frame.placed;
  alignment.sigma_layout_m = std::move(frame.sigma_layout_m);
  if (frame.note) alignment.notes.push_back(std::move(*frame.note));
  const bool has_gaps = joint.team.segments.size() > joint.robots.size();
  alignment.of_segment = segments_apart(joint, frame.component);
  if (has_gaps) set_components(joint, std::vector<int>(alignment.of_segment), alignment);
  alignment.absolute = absolute_components(joint, alignment.component);
  if (has_gaps) set_placed(alignment);
  remember_component(alignment);
  return alignment;
}

#define RADIOSLAM_TEAM_ALIGNMENT(Pose)                                                                       \
  template std::vector<int> set_components(const JointGraph<Pose>&, const std::vector<int>&,                 \
                                           TeamAlignment<Pose>&);                                            \
  template void set_placed(TeamAlignment<Pose>&);                                                            \
  template bool has_untied_poses(const JointGraph<Pose>&, const TeamAlignment<Pose>&);                       \
  template void leave_out_untied_poses(JointGraph<Pose>&, const TeamAlignment<Pose>&);                       \
  template void set_alternatives(TeamAlignment<Pose>&, const std::vector<TeamHypothesis<Pose>>&);            \
  template bool has_radio_links(const JointGraph<Pose>&);                                                    \
  template TeamAlignment<Pose> align_by_links(JointGraph<Pose>&, const RadioAlignmentParams&,                \
                                              const Progress&, const TeamAlignment<Pose>*, AlignmentSearch); \
  template TeamAlignment<Pose> align_robots_by_fingerprints(                                                 \
      JointGraph<Pose>&, const Mission&, const KnownStarts&, const RadioMeasurements&, const LayoutParams&,  \
      const FieldParams&, const Progress&);
RADIOSLAM_TEAM_ALIGNMENT(SE2)
RADIOSLAM_TEAM_ALIGNMENT(SE3)
#undef RADIOSLAM_TEAM_ALIGNMENT

}  // namespace radioslam
