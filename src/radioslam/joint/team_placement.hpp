// Team alignment: puts all robots of the joint graph into one frame, by ranges and angles of arrival if there
// are any, else by fingerprint similarity.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

/// Robots with a common frame, and alternative hypotheses of their alignment.
template <class Pose>
struct TeamPlacement {
  std::vector<int> component;                   ///< per robot; 0 is the first robot's
  std::vector<bool> placed;                     ///< per robot; false: no measurement connects it to others
  std::vector<bool> absolute;                   ///< per component: its frame is the common one
  double weight = 1;                            ///< of the hypothesis that the graph holds
  std::vector<std::vector<Pose>> alternatives;  ///< all poses of the graph, most likely first
  std::vector<double> alternative_weights;
};

/// Whether radio links connect robots to each other or to anchors.
template <class Pose>
bool has_radio_links(const JointGraph<Pose>& joint);

/// Aligns robots by their links, assigns weights to all links, and adds paths of angles that may be direct as
/// bearing factors.
template <class Pose>
TeamPlacement<Pose> place_by_radio(JointGraph<Pose>& joint, const RadioAlignmentParams& params,
                                   const Progress& progress);

template <class Pose>
TeamPlacement<Pose> place_by_fingerprints(JointGraph<Pose>& joint, const Mission& mission,
                                          const KnownStarts& starts, const RadioMeasurements& radio,
                                          const LayoutParams& params, const Progress& progress);

}  // namespace radioslam
