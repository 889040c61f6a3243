// Simulated paths of one angle measurement: directions in the receiver's body frame, each with a power.
//
// The direct path points to the transmitter, a mirror image to its reflection in a wall. Both carry isotropic
// Gaussian noise across their direction. False paths have uniform azimuths and bounded elevations. Powers are
// Gaussian: those of direct paths have mean 0 dB, so that the distributions of the others overlap with them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/sim/sensors/radio_channel.hpp"

namespace radioslam {

/// A vertical wall: a plane through `point` with a horizontal unit normal; all in the common frame.
struct Wall {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();

  /// Mirror image of a position.
  Eigen::Vector3d image(const Eigen::Vector3d& position) const {
    return position - 2 * normal.dot(position - point) * normal;
  }
};

/// The wall beside a robot's street, constant along each section of its path: parallel to the line between
/// the section's ends, on a random side per section.
class MirrorWalls {
 public:
  MirrorWalls(const Trajectory<SE3>& truth, const RadioChannelParams& params, const Rng& rng);
  const Wall& at(Stamp stamp) const;

 private:
  std::vector<Stamp> begins_;
  std::vector<Wall> walls_;
};

/// Paths, strongest first, and which of them is direct.
struct DrawnPaths {
  std::vector<AoaPath> paths;  ///< may be empty
  int direct = -1;
};

DrawnPaths draw_paths(const SE3& T_common_receiver, const Eigen::Vector3d& transmitter,
                      const std::optional<Wall>& wall, int dimension, const RadioChannelParams& params,
                      const Rng& rng);

}  // namespace radioslam
