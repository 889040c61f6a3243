// A robot's drive over the lanes: its route over crossings, and its pose after any path length.
//
// The route is a random walk without U-turns that prefers less used lanes: a lane's probability is
// proportional to 1 / (1 + times used). A route longer than all lanes together therefore revisits most of
// them. The robot takes corners on arcs and wanders sideways about the centre line, so that it never follows
// the same line twice.
#pragma once

#include <array>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/worlds/hills.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"

namespace radioslam {

/// Length, speed and lateral accuracy of a drive.
struct DriveParams {
  double path_length_m = 600;
  double speed_mps = 0.4;
  double corner_radius_m = 2.5;
  double sigma_wander_m = 0.4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(path_length_m, "m", 1, 100000,
                          "path length of each robot along the lanes' centre lines");
    RADIOSLAM_BASIC_FIELD(speed_mps, "m/s", 0.01, 10, "driving speed; 0.4 in Liu et al.");
    RADIOSLAM_FIELD(corner_radius_m, "m", 0.5, 4, "radius of the arcs around corners");
    RADIOSLAM_FIELD(sigma_wander_m, "m", 0, 0.6, "standard deviation of the sideways wander on a lane");
  }
};

/// Successive crossings from `start`, until the path is at least `length_m` long.
std::vector<std::size_t> draw_route(const LaneGrid& lanes, std::size_t start, double length_m, Rng rng);

/// Corners of a drive of `path_length_m` from a crossing: the crossings of a sufficiently long route.
std::vector<Eigen::Vector2d> draw_corners(const LaneGrid& lanes, std::size_t start, double path_length_m,
                                          const Rng& rng);

/// Pose on a drive, by path length along the centre lines.
class Drive {
 public:
  /// `corners` as the crossings of a route, no two consecutive ones equal. Between short lanes, corners are
  /// sharper than requested.
  Drive(const std::vector<Eigen::Vector2d>& corners, const DriveParams& params, Rng rng);

  double length_m() const { return length_m_; }
  /// T_floor_body after path length `path_m` in [0, length_m()].
  SE2 pose_at(double path_m) const;

 private:
  /// A line (curvature 0) or an arc.
  struct PathSegment {
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
  void append_line_to(const Eigen::Vector2d& target);
  void append_corner(double turn_rad, double radius_m);

  double length_m_ = 0;
  std::vector<PathSegment> segments_;
  std::array<Wave, 4> waves_;
};

/// Drives of a team over a grid of lanes, such that its robots come into range of each other.
///
/// Each robot drives its own route (drive.hpp) from its own crossing. Routes are drawn until the robot is
/// within `contact_range_m` of an earlier one for `min_contact_s`, a quarter of that in every quarter of the
/// mission; if no draw is, the one with the longest contact is used. So the team is connected by contacts
/// spread over the mission, and its routes partly overlap.
struct TeamDriveParams {
  int robots = 2;
  DriveParams drive;
  double rate_hz = 10;  ///< poses per second
  double contact_range_m = 100;
  double min_contact_s = 0;
  int draws = 100;
};

/// T_common_body of each robot, all from time 0. A larger team keeps the drives of its first robots.
std::vector<Trajectory<SE3>> drive_team(const LaneGrid& lanes, const Hills& ground,
                                        const TeamDriveParams& params, const Rng& rng);

}  // namespace radioslam
