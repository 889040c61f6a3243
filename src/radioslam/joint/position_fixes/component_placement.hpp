// Robots whose frame is common but nobody else's, and whose own fixes are too few or too imprecise for a
// heading: the fixes of all of them together may give the frame its place.
//
// The aligned robots are one rigid body, which is aligned with all fixes (team_frame/fix_alignment.hpp, with
// the uncertainty of a robot's place in a layout by fingerprints added to the sigma of its fixes) and moved
// there if enough of these agree and determine a heading, by the conditions that hold for a single robot.
#pragma once

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/joint/team_alignment.hpp"

namespace radioslam {

/// Moves components that their robots' fixes can place into the common frame, which makes them absolute.
/// Components of which other alignments are likely stay where they are.
template <class Pose>
void place_components_by_fixes(JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes, const FixParams& params,
                               TeamAlignment<Pose>& alignment);

}  // namespace radioslam
