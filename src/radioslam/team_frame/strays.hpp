// Robots that a layout put far from every place that sounds like theirs.
//
// Scans that hold few access points are unlike all others, which a layout by distances reads as being far
// away; yet the scans most like them are mostly right. A stray is a robot whose scans lie further from their
// most similar ones of three other robots than is usual in the team; it is moved, unturned, to where its
// scans and their most similar ones agree best.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

/// Moves the strays among the free bodies, the worst first, and returns their indices. `similarity`: nodes x
/// nodes of the bodies' points, larger is more alike; only its order counts, and zero is no likeness at all.
/// Usual is up to three robust standard deviations (1.48 median absolute deviations) above the team's median.
std::vector<std::size_t> relocate_strays(std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity);

}  // namespace radioslam
