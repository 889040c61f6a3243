// Radio paths between two antennas in a room, by image sources: direct, and reflected by walls.
//
// A wall is a vertical plane above a segment of the floor. It shows the transmitter's mirror image behind it:
// a path reflected by walls 1, ..., n is as long as the straight line from the n-fold image of the
// transmitter to the receiver, and exists if every reflection falls on its wall's segment. Each crossing of
// another wall costs `loss_db`. Amplitude: 1 at 1 m, inversely proportional to the length, times the
// reflection coefficient of every bounce. Source: Allen and Berkley 1979, for finite walls. Cost:
// walls^(bounces + 1).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace radioslam {

/// A wall above the floor's segment from `begin` to `end`, in the common frame.
struct WallSegment {
  Eigen::Vector2d begin_m, end_m;
  double reflection = -0.4;  ///< amplitude ratio; negative: phase inversion
  double loss_db = 8;        ///< on transmission

  double distance_m(const Eigen::Vector2d& point) const;
};

/// Ratio of the leg at which it crosses the wall's segment; nothing where it does not, or only touches it.
std::optional<double> crossing(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               const WallSegment& wall);

/// A path from a transmitter to a receiver.
struct RadioPath {
  double length_m = 0;
  double amplitude = 0;  ///< 1: a direct path at 1 m; negative: phase inversion
  int bounces = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, from the receiver towards the arriving wave
};

struct ImageParams {
  int max_bounces = 2;        ///< 0 to 2
  double obstruction_db = 0;  ///< loss of the direct path in addition to that of walls
};

/// All paths, the direct one first.
std::vector<RadioPath> image_paths(const Eigen::Vector3d& transmitter_m, const Eigen::Vector3d& receiver_m,
                                   const std::vector<WallSegment>& walls, const ImageParams& params);

}  // namespace radioslam
