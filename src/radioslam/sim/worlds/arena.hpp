// A square floor with outer walls and boxes on it, for robots that move in the plane.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/sim/sensors/image_sources.hpp"

namespace radioslam {

struct ArenaBox {
  Eigen::Vector2d low_m, high_m;  ///< corners
};

class Arena {
 public:
  /// A floor from (0, 0) to (side, side) with boxes at random places that leave gangways between them.
  Arena(double side_m, int boxes, Rng rng);

  double side_m() const { return side_m_; }
  const std::vector<ArenaBox>& boxes() const { return boxes_; }
  /// Outer walls and sides of boxes, for radio.
  const std::vector<WallSegment>& walls() const { return walls_; }
  /// A place for a robot, drawn evenly.
  Eigen::Vector2d free_place(Rng& rng) const;
  /// How far one gets from `from` towards `to`, before a wall by the clearance of a robot.
  Eigen::Vector2d reach(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  /// Distance to the next wall along a direction, up to `range_m`.
  std::optional<double> wall_ahead(const Eigen::Vector2d& from, double heading_rad, double range_m) const;
  bool in_sight(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

 private:
  double side_m_;
  std::vector<ArenaBox> boxes_;
  std::vector<WallSegment> walls_;
};

}  // namespace radioslam
