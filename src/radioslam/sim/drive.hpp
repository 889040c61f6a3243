// A robot's drive over the lanes: which crossings it passes, and where it is after any way.
//
// The route is a walk without turning back that prefers lanes it has used less: the chance of a lane is
// proportional to 1 / (1 + times used). A route longer than the lanes together therefore comes back to
// most of them. The robot takes corners on arcs and wanders sideways about the centre line, so that it never
// drives the same line twice.
#pragma once

#include <array>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/sim/lane_grid.hpp"

namespace radioslam {

/// How far, how fast and how neatly a robot drives.
struct DriveParams {
  double path_length_m = 600;
  double speed_mps = 0.4;
  double corner_radius_m = 2.5;
  double sigma_wander_m = 0.4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"path_length_m", "m", 1, 100000, "way of each robot along the lanes' centre lines"},
          self.path_length_m);
    visit(Field{"speed_mps", "m/s", 0.01, 10, "speed; 0.4 in the published test"}, self.speed_mps);
    visit(Field{"corner_radius_m", "m", 0.5, 4, "radius of the arc around a corner"}, self.corner_radius_m);
    visit(Field{"sigma_wander_m", "m", 0, 0.6, "standard deviation of the sideways wander on a lane"},
          self.sigma_wander_m);
  }
};

/// Crossings passed from `start`, one after the other, until the way is at least `length_m` long.
std::vector<std::size_t> draw_route(const LaneGrid& lanes, std::size_t start, double length_m, Rng rng);

/// Where a drive of `path_length_m` from a crossing turns: the crossings of a route that is long enough.
std::vector<Eigen::Vector2d> draw_corners(const LaneGrid& lanes, std::size_t start, double path_length_m,
                                          const Rng& rng);

/// Where a drive leads, by the way along the centre lines.
class Drive {
 public:
  /// `corners` as the crossings of a route, no two consecutive ones in the same place. Corners between short
  /// lanes are sharper than asked for.
  Drive(const std::vector<Eigen::Vector2d>& corners, const DriveParams& params, Rng rng);

  double length_m() const { return length_m_; }
  /// T_floor_body after `way_m` in [0, length_m()].
  SE2 pose_at(double way_m) const;

 private:
  /// A line (curvature 0) or an arc.
  struct Piece {
    double begin_m = 0;
    double length_m = 0;
    SE2 T_floor_begin;
    double curvature_per_m = 0;  ///< positive to the left
  };
  /// One sine of the sideways wander.
  struct Wave {
    double amplitude_m = 0;
    double wavenumber_per_m = 0;
    double phase_rad = 0;
  };
  void append(const SE2& T_floor_begin, double length_m, double curvature_per_m);
  void append_way_to(const Eigen::Vector2d& target);
  void append_corner(double turn_rad, double radius_m);

  double length_m_ = 0;
  std::vector<Piece> pieces_;
  std::array<Wave, 4> waves_;
};

}  // namespace radioslam
