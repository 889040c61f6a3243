// How well a layout of rigid trajectories by fingerprints is known.
//
// What is wrong with a layout (a wing attached at the wrong place, walls that make near places dissimilar)
// leaves no trace in its residuals. So it is made again from either half of the access points alone, and from
// either model of distance; where these layouts disagree, the layout is uncertain. The errors that the halves
// share are taken to be as large as those they do not. With moved the displacement of a robot's centre from
// the layout in one made again, the variance per axis of its place is
//
//   max(0, mean |moved|^2 - (2 sigma_0)^2) + (sigma_size beyond)^2 + sum w |moved|^2 / 2
//
// Displacements below 2 sigma_0 are those that near fingerprints take back when the team is optimised.
// `beyond` is by how much the robot's centre lies further from the centre of the team than its own trajectory
// reaches: its odometry holds the size of what it has seen itself. The last sum is over other layouts by all
// access points, such as the mirror image, with weights w by their likelihood.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/team_frame/layout_evidence.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"
#include "radioslam/team_frame/scaled_layouts.hpp"

namespace radioslam {

/// Whether an access point belongs to the second half. `bssids` are sorted. The networks of one box, whose
/// addresses differ in the last digit alone, belong to the same half.
std::vector<bool> second_half(const std::vector<std::string>& bssids);

/// Displacement of every body's centre from `layout` to `other`, which is moved onto it group by group as a
/// rigid body, but for groups with fixed bodies. `group_of`: per body. 0 for bodies without points.
std::vector<double> centre_moves_m(const std::vector<RigidBody>& layout, const std::vector<RigidBody>& other,
                                   const std::vector<std::size_t>& group_of);

/// Another layout by all access points: the mirror image, or one by another model of distance.
struct AlternativeLayout {
  std::vector<double> moves_m;  ///< centre_moves_m from the layout that was chosen
  double weight = 0;            ///< likelihood over that of the layout that was chosen, from 0 to 1
};

/// Standard deviation of every body's place, per axis; 0 for fixed bodies and for those alone in their group.
/// `by_halves`: the layout and its mirror image by each half and model.
std::vector<double> layout_sigmas_m(const std::vector<RigidBody>& layout,
                                    const std::vector<std::vector<Layout>>& by_halves,
                                    const std::vector<AlternativeLayout>& alternatives,
                                    const std::vector<std::size_t>& group_of, const LayoutParams& params);

}  // namespace radioslam
