// The driving lanes of a car park: a grid of aisles between rows of bays, some of them walled off.
//
// Frame: x along the long side, y along the short side, origin at a corner of the floor; metres. Rows of
// bays with their pillars fill the space between aisles, so a lane's width is that of an aisle.
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
  int aisles_along_y = 6;           ///< aisles that run along y, spread over x
  int aisles_along_x = 4;           ///< aisles that run along x, spread over y
  double margin_m = 5;              ///< outer aisles' centre lines to the outer walls
  double closed_lane_share = 0.15;  ///< lanes between crossings that a wall or a stairwell closes

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"floor_x_m", "m", 20, 1000, "long side of the floor (5,100 m^2 in the published test)"},
          self.floor_x_m);
    visit(Field{"floor_y_m", "m", 20, 1000, "short side of the floor"}, self.floor_y_m);
    visit(Field{"aisles_along_y", "", 2, 50, "aisles along y: every 15 m, two rows of 4.5 m bays between"},
          self.aisles_along_y);
    visit(Field{"aisles_along_x", "", 2, 50, "aisles along x"}, self.aisles_along_x);
    visit(Field{"margin_m", "m", 2, 9, "outer aisles' centre lines to the outer walls"}, self.margin_m);
    visit(Field{"closed_lane_share", "", 0, 0.5, "share of the lanes between two crossings that are closed"},
          self.closed_lane_share);
  }
};

/// Crossings and the open lanes between them. Connected; at least two lanes meet at every crossing, so that
/// a drive never has to turn on the spot.
class LaneGrid {
 public:
  LaneGrid(const LaneGridParams& params, Rng rng);

  std::size_t size() const { return crossings_.size(); }
  const Eigen::Vector2d& crossing(std::size_t i) const { return crossings_[i]; }
  /// Crossings one open lane away, in increasing order.
  const std::vector<std::size_t>& neighbours(std::size_t i) const { return neighbours_[i]; }
  std::size_t lane_count() const;
  /// From a point to the nearest centre line of an open lane.
  double distance_to_lane_m(const Eigen::Vector2d& point) const;

 private:
  void open_lane(std::size_t i, std::size_t j);
  void close_lane(std::size_t i, std::size_t j);
  bool connected() const;

  std::vector<Eigen::Vector2d> crossings_;
  std::vector<std::vector<std::size_t>> neighbours_;
};

}  // namespace radioslam
