// Rigid alignment of matched positions, of a whole team or of one robot.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "radioslam/eval/association.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// Estimated and true positions, one column each, in metres.
struct MatchedPositions {
  Eigen::Matrix3Xd estimate, truth;
};

/// Positions of all robots' matched poses, in their order.
MatchedPositions positions_of(std::span<const std::vector<MatchedPose>> robots);

/// T_truth_estimate that minimises the sum of squared distances, never a reflection; with `dimension` 2 in
/// the plane. Identity without positions.
SE3 align_positions(const MatchedPositions& positions, int dimension);

}  // namespace radioslam
