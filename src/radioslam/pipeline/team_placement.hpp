// Puts the joint graph's robots into one frame: by ranges and angles where the mission has any, else by how
// similar their fingerprints are.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

/// Which robots share a frame, and how else they may lie in it.
template <class Pose>
struct TeamPlacement {
  std::vector<int> component;                   ///< per robot; 0 is the first robot's
  std::vector<bool> placed;                     ///< per robot; false: nothing ties it to its component
  std::vector<bool> absolute;                   ///< per component: its frame is the common one
  double weight = 1;                            ///< of the placement that the graph has now
  std::vector<std::vector<Pose>> alternatives;  ///< all poses of the graph, likeliest first
  std::vector<double> alternative_weights;
};

/// Radio links tie robots to each other or to anchors.
template <class Pose>
bool has_radio_links(const JointGraph<Pose>& joint);

/// Moves the robots by their links, gives every link its weight, and turns the paths of angles that may be
/// direct into bearings of the graph.
template <class Pose>
TeamPlacement<Pose> place_by_radio(JointGraph<Pose>& joint, const RadioAlignmentParams& params,
                                   const Progress& progress);

template <class Pose>
TeamPlacement<Pose> place_by_fingerprints(JointGraph<Pose>& joint, const Mission& mission,
                                          const RadioMeasurements& radio, const LayoutParams& params,
                                          const Progress& progress);

}  // namespace radioslam
