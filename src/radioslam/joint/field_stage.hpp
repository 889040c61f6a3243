// Radio field refinement of a team aligned by fingerprints: moves robots to agree with their common field
// (team_frame/field_refinement.hpp) and updates the distances that keep the layout.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/team_frame/field_refinement.hpp"

namespace radioslam {

/// Moves robots of unknown start rigidly, from their optimized trajectories, component by component.
/// Distances of layout closures in the graph become those between the new positions. `closures` are those of
/// the graph, in order. False if there is nothing to refine.
template <class Pose>
bool refine_by_radio_field(JointGraph<Pose>& joint, const Mission& mission, const KnownStarts& starts,
                           const RadioMeasurements& radio, const TeamAlignment<Pose>& alignment,
                           const std::vector<FingerprintClosure>& closures, const FieldParams& params,
                           const Progress& progress);

}  // namespace radioslam
