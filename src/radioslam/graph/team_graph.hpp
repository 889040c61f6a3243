// A pose graph whose parts do not yet share a frame: the trajectories of a team, each in a frame of its own,
// and what ties them together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Poses of one robot that odometry ties into a chain: pose k + 1 to pose k by a RelativePoseFactor.
/// Consecutive poses of the graph. Where odometry is missing, a robot has several pieces.
struct Piece {
  std::string robot;
  std::size_t first_pose = 0, pose_count = 0;
  std::vector<Stamp> stamps;     ///< of the poses
  double sigma_heading_rad = 0;  ///< > 0: the piece's own frame has the common heading up to this error
  bool in_common_frame = false;  ///< its start is known: values and a prior hold in the common frame
};

/// Moves the piece rigidly: its poses <- T * its poses.
template <class Pose>
void move_piece(std::vector<Pose>& poses, const Piece& piece, const Pose& T) {
  for (std::size_t k = piece.first_pose; k < piece.first_pose + piece.pose_count; ++k)
    poses[k] = T * poses[k];
}

/// One of the directions of an AmbiguousBearing.
template <class Pose>
struct BearingPath {
  typename Pose::Point direction = Pose::Point::UnitX();  ///< unit vector in the receiver's body frame
  double sigma_rad = 1;
  double power_db = 0;
};

/// Several directions from pose i of which at most one leads to the end j: BearingFactor with choices.
template <class Pose>
struct AmbiguousBearing {
  PoseId i;
  RangeEnd<Pose> j;
  std::vector<BearingPath<Pose>> paths;
};

/// Values of poses hold in their piece's own frame (pieces tied by a known start or a prior: in the common
/// frame); values of points that nothing ties to a frame mean nothing yet.
/// graph.bearings is empty: the bearings are in `bearings`.
template <class Pose>
struct TeamGraph {
  PoseGraph<Pose> graph;
  std::vector<Piece> pieces;
  std::vector<AmbiguousBearing<Pose>> bearings;
};

}  // namespace radioslam
