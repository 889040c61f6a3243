// The ways by which a radio wave gets from one antenna to another in a room: straight, and by way of walls.
//
// A wall is an upright plane over a segment of the floor, as high as need be. It shows the transmitter's
// image behind itself: a path that bounces off walls 1, ..., n is as long as the straight line from the
// image of the image ... of the transmitter to the receiver, and exists where every bounce falls on its
// segment. A leg of the path that passes through another wall loses `loss_db` there. Amplitude: 1 at 1 m,
// falling with the length, times the reflection coefficient of every bounce.
// Source: Allen and Berkley 1979, for finite walls. Cost: walls^(bounces + 1).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace radioslam {

/// A wall over the floor's segment from `begin` to `end`, in the common frame.
struct WallSegment {
  Eigen::Vector2d begin_m, end_m;
  double reflection = -0.4;  ///< of the amplitude; negative: the phase turns over
  double loss_db = 8;        ///< of what passes through

  double distance_m(const Eigen::Vector2d& point) const;
};

/// One way from a transmitter to a receiver.
struct RadioPath {
  double length_m = 0;
  double amplitude = 0;  ///< 1: that of the straight way at 1 m; negative: turned over
  int bounces = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, from the receiver to where it came from
};

struct ImageParams {
  int most_bounces = 2;       ///< 0 to 2
  double obstruction_db = 0;  ///< loss of the straight path beside that of the walls in its way
};

/// All paths, the straight one first.
std::vector<RadioPath> image_paths(const Eigen::Vector3d& transmitter_m, const Eigen::Vector3d& receiver_m,
                                   const std::vector<WallSegment>& walls, const ImageParams& params);

}  // namespace radioslam
