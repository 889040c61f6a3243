// Team alignment: puts all robots of the joint graph into one frame, by ranges and angles of arrival if there
// are any, else by fingerprint similarity.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

/// Robots with a common frame, and alternative hypotheses of their alignment.
template <class Pose>
struct TeamAlignment {
  TeamComponents segments;                      ///< of the alignment by radio; empty without
  std::vector<int> component;                   ///< per robot; 0 is the first robot's
  std::vector<int> of_segment;                  ///< the component of every segment
  std::vector<int> without_matches;             ///< the component before matches joined any
  std::vector<bool> in_common_frame;            ///< per robot, before matches joined any component
  std::vector<bool> placed;                     ///< per robot; false: no measurement connects it to others
  std::vector<bool> absolute;                   ///< per component: its frame is the common one
  double weight = 1;                            ///< of the hypothesis that the graph holds
  std::vector<std::vector<Pose>> alternatives;  ///< all poses of the graph, most likely first
  std::vector<double> alternative_weights;
  std::vector<double> sigma_layout_m;  ///< per robot placed by fingerprints (TeamFrame); empty without
  std::vector<std::string> notes;      ///< on what the frame stands
};

/// Weight of an alternative from which its overlaps and places are searched, too.
inline constexpr double kMinSearchedWeight = 0.01;

/// Whether other measurements than matches determine the relative pose of two robots.
template <class Pose>
bool connected_without_matches(const TeamAlignment<Pose>& alignment, RobotIndex i, RobotIndex j) {
  const int c_i = alignment.without_matches[i.index()], c_j = alignment.without_matches[j.index()];
  return c_i == c_j || (alignment.in_common_frame[i.index()] && alignment.in_common_frame[j.index()]);
}

/// The same of any two robots.
template <class Pose>
bool relates_robots(const TeamAlignment<Pose>& alignment) {
  for (std::size_t i = 0; i < alignment.component.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (connected_without_matches(alignment, RobotIndex(i), RobotIndex(j))) return true;
  return false;
}

/// One note on all keyframes that were left out; nothing where none was.
std::optional<std::string> untied_note(const std::vector<RobotVariables>& robots);

/// Whether radio links connect robots to each other or to anchors.
template <class Pose>
bool has_radio_links(const JointGraph<Pose>& joint);

/// Whether all alignments are searched, or those known before refined.
enum class AlignmentSearch { kAll, kNearKnown };

/// Aligns robots by their links, assigns weights to all links, and adds paths of angles that may be direct as
/// bearing factors. `before`: the alignment so far of this team, whose best one the graph's values are;
/// another one replaces it only where it is clearly likelier (team_frame/alignment_continuity.hpp). Null:
/// there is none, and all are searched.
template <class Pose>
TeamAlignment<Pose> align_by_links(JointGraph<Pose>& joint, const RadioAlignmentParams& params,
                                   const Progress& progress, const TeamAlignment<Pose>* before = nullptr,
                                   AlignmentSearch search = AlignmentSearch::kAll);

/// Sets the weight of the first of these hypotheses, best first, and the alternatives that are likely enough
/// to be searched.
template <class Pose>
void set_alternatives(TeamAlignment<Pose>& alignment, const std::vector<TeamHypothesis<Pose>>& hypotheses);

/// Sets the components. A robot with segments in several belongs to the one with the most poses of the team,
/// before others to that of known starts; its other segments have no pose in its frame. `of_segment` has the
/// same number, from 0, for segments that share a frame. Returns the new number of each, -1 where no robot
/// has it.
template <class Pose>
std::vector<int> set_components(const JointGraph<Pose>& joint, const std::vector<int>& of_segment,
                                TeamAlignment<Pose>& alignment);

/// Sets which robots are placed: not those that are alone in a component other than the first robot's and not
/// in the common frame.
template <class Pose>
void set_placed(TeamAlignment<Pose>& alignment);

/// Whether a robot has poses in another component than its own.
template <class Pose>
bool has_untied_poses(const JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment);

/// Leaves to every robot those of its keyframes that are in its component: what is behind a gap of the
/// odometry, and tied by nothing to the rest, has no pose there. The graph keeps its poses.
template <class Pose>
void leave_out_untied_poses(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment);

template <class Pose>
TeamAlignment<Pose> align_robots_by_fingerprints(JointGraph<Pose>& joint, const Mission& mission,
                                                 const KnownStarts& starts, const RadioMeasurements& radio,
                                                 const LayoutParams& params, const FieldParams& field,
                                                 const Progress& progress);

}  // namespace radioslam
