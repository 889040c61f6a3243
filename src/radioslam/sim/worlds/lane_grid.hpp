// Lane grid of a car park: aisles between rows of bays, some of them closed.
//
// Frame: x along the long side, y along the short side, origin at a corner of the floor; metres. Rows of bays
// with their pillars fill the space between aisles, so a lane is as wide as an aisle.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {

/// Size and layout of a car park's floor.
struct LaneGridParams {
  double floor_x_m = 85;
  double floor_y_m = 60;
  int aisles_along_y = 6;  ///< spread over x
  int aisles_along_x = 4;  ///< spread over y
  double margin_m = 5;
  double closed_lane_ratio = 0.15;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(floor_x_m, "m", 20, 1000, "long side of the floor (5,100 m^2 in Liu et al.)");
    RADIOSLAM_BASIC_FIELD(floor_y_m, "m", 20, 1000, "short side of the floor");
    RADIOSLAM_FIELD(aisles_along_y, "", 2, 50,
                    "number of aisles along y (default: every 15 m, with two rows of 4.5 m bays between)");
    RADIOSLAM_FIELD(aisles_along_x, "", 2, 50, "number of aisles along x");
    RADIOSLAM_FIELD(margin_m, "m", 2, 9, "distance from the outer aisles' centre lines to the outer walls");
    RADIOSLAM_FIELD(closed_lane_ratio, "", 0, 0.5,
                    "ratio of lanes between crossings that are closed by a wall or stairwell");
  }
};

/// Crossings and the open lanes between them. Connected, with at least two lanes at every crossing, so that a
/// drive never has to turn on the spot.
class LaneGrid {
 public:
  LaneGrid(const LaneGridParams& params, Rng rng);

  std::size_t size() const { return crossings_.size(); }
  const Eigen::Vector2d& crossing(std::size_t i) const { return crossings_[i]; }
  /// Crossings one open lane away, in increasing order.
  const std::vector<std::size_t>& neighbours(std::size_t i) const { return neighbours_[i]; }
  std::size_t lane_count() const;
  /// Distance from a point to the nearest centre line of an open lane.
  double distance_to_lane_m(const Eigen::Vector2d& point) const;

 private:
  void open_lane(std::size_t i, std::size_t j);
  void close_lane(std::size_t i, std::size_t j);
  bool connected() const;

  std::vector<Eigen::Vector2d> crossings_;
  std::vector<std::vector<std::size_t>> neighbours_;
};

}  // namespace radioslam
