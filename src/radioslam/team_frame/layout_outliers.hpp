// Finds and corrects robots that a fingerprint layout placed far from where similar fingerprints were
// measured.
//
// Fingerprints with few access points have low similarity to all others, which a distance-based layout
// interprets as large distances, although their most similar fingerprints are mostly right. An outlier is a
// robot whose fingerprints are further from their most similar ones of three other robots than is typical for
// the team; it is translated, without rotation, to where its fingerprints agree best with their most similar
// ones.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

/// Moves the outliers among the free bodies, the worst first, and returns their indices. `similarity`: nodes
/// x nodes of the bodies' points; only its order counts, and zero means nothing in common. Outliers exceed
/// the team's median distance by three robust standard deviations (1.48 median absolute deviations).
std::vector<std::size_t> relocate_outliers(std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity);

}  // namespace radioslam
