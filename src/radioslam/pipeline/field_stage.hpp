// Refines a team that fingerprints have placed by the radio field that its robots share
// (team_frame/field_refinement.hpp), and lets the ties that hold the layout say what the field says.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/team_placement.hpp"
#include "radioslam/team_frame/field_refinement.hpp"

namespace radioslam {

/// Moves the robots of unknown starts rigidly, each as its optimised trajectory lies, component by component;
/// the distances of layout closures, in the graph and in `closures`, become those between the moved places.
/// `closures` are those of the graph, in order. False where there was nothing to refine.
template <class Pose>
bool refine_by_radio_field(JointGraph<Pose>& joint, const Mission& mission, const RadioMeasurements& radio,
                           const TeamPlacement<Pose>& placement, std::vector<FingerprintClosure>& closures,
                           const FieldParams& params, const Progress& progress);

}  // namespace radioslam
