// The paths of one angle measurement: directions in the receiver's body frame, each with a power.
//
// The direct one points to the transmitter. A mirror image points to where a wall shows it. Both carry
// Gaussian noise, across the direction and the same each way. False ones come from anywhere around, at most
// some degrees above or below. Power is Gaussian: a direct path's mean is 0 dB, so that the others'
// distributions overlap with it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/sim/radio_channel.hpp"

namespace radioslam {

/// A vertical wall: a plane through `point` with a level unit normal; all in the common frame.
struct Wall {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();

  /// Where the wall shows what is at `position`.
  Eigen::Vector3d image(const Eigen::Vector3d& position) const {
    return position - 2 * normal.dot(position - point) * normal;
  }
};

/// The wall beside a robot's street, the same along each stretch of its way: parallel to the way between the
/// stretch's ends, on a side that is drawn per stretch.
class StreetWalls {
 public:
  StreetWalls(const Trajectory<SE3>& truth, const RadioChannelParams& params, const Rng& rng);
  const Wall& at(Stamp stamp) const;

 private:
  std::vector<Stamp> begins_;
  std::vector<Wall> walls_;
};

/// The paths, the strongest first, and which of them is direct.
struct DrawnPaths {
  std::vector<ArrivalPath> paths;  ///< may be empty
  int direct = -1;
};

DrawnPaths draw_paths(const SE3& T_common_receiver, const Eigen::Vector3d& transmitter,
                      const std::optional<Wall>& wall, int dimension, const RadioChannelParams& params,
                      const Rng& rng);

}  // namespace radioslam
