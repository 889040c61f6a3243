// Compresses a team graph to the poses with measurements other than odometry: the odometry between two kept
// poses becomes one relative pose with the covariance and drift Jacobian of the composition. For increments Z
// with covariance S and drift Jacobian D (right perturbations):
//   (S, D) <- (Ad(Z^-1) S Ad(Z^-1)^T + S_k, Ad(Z^-1) D + D_k).
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/graph/team_graph.hpp"
#include "radioslam/team_frame/alignment_grid.hpp"

namespace radioslam {

// Thins the links of a team so that no pair of segments holds more than the alignment search needs.

/// Keeps at most GridParams::max_links ranges, as many bearings, and max_sightings relative points between
/// two segments or a segment and a point, evenly spread; and as many fewer between the segments of a large
/// team as keep the ranges of a segment within max_links_of_robot, but eight of each pair.
template <class Pose>
TeamGraph<Pose> thin_links(const TeamGraph<Pose>& team, const GridParams& params);

inline constexpr std::int32_t kNoOdometry = -1;

/// Index of the odometry factor from the preceding pose of its segment to each pose; kNoOdometry if there is
/// none.
template <class Pose>
std::vector<std::int32_t> odometry_into(const TeamGraph<Pose>& team);

template <class Pose>
struct CompressedTeam {
  TeamGraph<Pose> team;           ///< points and drifts in the order of the full graph
  std::vector<PoseId> full_pose;  ///< pose in the full graph, per compressed pose
};

/// Keeps the first pose of every segment and all poses with a factor other than the segment's odometry.
template <class Pose>
CompressedTeam<Pose> compress(const TeamGraph<Pose>& full);

/// Copies the compressed graph's values to the full graph; poses in between follow from the preceding kept
/// pose by odometry.
template <class Pose>
void expand_values(const CompressedTeam<Pose>& compressed, TeamGraph<Pose>& full);

}  // namespace radioslam
