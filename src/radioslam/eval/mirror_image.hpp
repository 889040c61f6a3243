// Mirrored ground truth: whether an estimate fits the truth only as its mirror image.
//
// Both alignments minimise the RMSE of the positions: the rigid one, and one of the estimate reflected first
// (y in the plane, z in space). A mirror image is reported where the reflected fit's RMSE is below a quarter
// of the rigid one's, and the rigid one's above a tenth of the truth's extent (RMS distance from its
// centroid). Straight paths, in space also planar ones, are their own mirror images: both fits are equally
// good. A path with standard deviation s across its main direction has a rigid RMSE of 2 s where it is
// mirrored, so that those narrower than a twentieth of their extent are not tested.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "radioslam/eval/association.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

// Rigid alignment of matched positions, of a whole team or of one robot.

/// Estimated and true positions, one column each, in metres.
struct MatchedPositions {
  Eigen::Matrix3Xd estimate, truth;
};

/// Positions of all robots' matched poses, in their order.
MatchedPositions positions_of(std::span<const std::vector<MatchedPose>> robots);

/// T_truth_estimate that minimises the sum of squared distances, never a reflection; with `dimension` 2 in
/// the plane. Identity without positions.
SE3 align_positions(const MatchedPositions& positions, int dimension);

/// The whole team's if it fits only as a mirror image; else those of the robots that do so alone. `matches`
/// are per robot of `truth`, reduced to the plane for `dimension` 2.
std::vector<MirrorImage> find_mirror_images(const Truth& truth,
                                            std::span<const std::vector<MatchedPose>> matches, int dimension);

/// A message for the user per mirror image.
std::vector<std::string> mirror_notes(const std::vector<MirrorImage>& images);

}  // namespace radioslam
