// Pose graph of a team whose trajectories do not share a frame yet: each segment is in its own frame, with
// the measurements between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Trajectory segment: consecutive poses of one robot, connected by odometry (a RelativePoseFactor from each
/// to the next). A robot whose odometry has gaps has several segments.
struct TrajectorySegment {
  std::string robot;
  std::size_t first_pose = 0, pose_count = 0;
  std::vector<Stamp> stamps;     ///< of the poses
  double sigma_heading_rad = 0;  ///< > 0: the segment's frame has the common heading up to this error
  bool in_common_frame = false;  ///< its start is known: values and prior are in the common frame
};

/// Moves the segment rigidly: its poses <- T * its poses.
template <class Pose>
void move_segment(std::vector<Pose>& poses, const TrajectorySegment& segment, const Pose& T) {
  for (std::size_t k = segment.first_pose; k < segment.first_pose + segment.pose_count; ++k)
    poses[k] = T * poses[k];
}

/// One of the directions of an AmbiguousBearing.
template <class Pose>
struct BearingPath {
  typename Pose::Point direction = Pose::Point::UnitX();  ///< unit vector in the receiver's frame
  double sigma_rad = 1;
  double power_db = 0;
  bool azimuth_only = false;  ///< as BearingFactor::azimuth_only
};

/// Several directions from pose i of which at most one leads to the end j: BearingFactor with choices.
template <class Pose>
struct AmbiguousBearing {
  PoseId i;
  RangeEnd<Pose> j;
  std::vector<BearingPath<Pose>> paths;
  Pose T_i_receiver{};
  std::int64_t after_ns = 0;  ///< measured so long after pose i
};

/// Path p of a bearing as a factor of its own.
template <class Pose>
BearingFactor<Pose> path_factor(const AmbiguousBearing<Pose>& bearing, std::size_t p) {
  const BearingPath<Pose>& path = bearing.paths[p];
  return {bearing.i, bearing.j, path.direction,    path.sigma_rad,
          {},        1,         path.azimuth_only, bearing.T_i_receiver};
}

/// The direction of path p in i's body frame.
template <class Pose>
typename Pose::Point direction_in_body(const AmbiguousBearing<Pose>& bearing, std::size_t p) {
  return bearing.T_i_receiver.rotation_matrix() * bearing.paths[p].direction;
}

/// Values of poses are in their segment's own frame (segments with a known start or a prior: in the common
/// frame); values of points without a connection to a frame are undefined. graph.bearings is empty: bearings
/// are in `bearings`.
template <class Pose>
struct TeamGraph {
  PoseGraph<Pose> graph;
  std::vector<TrajectorySegment> segments;
  std::vector<AmbiguousBearing<Pose>> bearings;
};

}  // namespace radioslam
