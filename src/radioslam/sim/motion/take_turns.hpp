// Drives in turns: one robot drives a short leg while all others are at rest.
//
// A leg is a turn on the spot, omitted if there is enough space ahead, and two arcs of different curvature.
// It starts and ends smoothly: after a ratio u of its time, the ratio u - sin(2 pi u) / (2 pi) of its path is
// covered. Legs are drawn until one keeps clear of walls and robots; if none does, the one with the largest
// clearance is used. After a leg and a pause, the next robot drives.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {

struct TurnDriveParams {
  int turns_per_robot = 8;
  double min_leg_m = 1;
  double max_leg_m = 2;
  double mean_speed_mps = 0.2;
  double pause_s = 1;
  double clearance_m = 0.8;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(turns_per_robot, "", 0, 1000, "number of legs per robot");
    RADIOSLAM_FIELD(min_leg_m, "m", 0.1, 20, "smallest path length of a leg");
    RADIOSLAM_FIELD(max_leg_m, "m", 0.1, 20, "largest path length of a leg");
    RADIOSLAM_FIELD(mean_speed_mps, "m/s", 0.02, 2, "mean speed over a leg; twice that in its middle");
    RADIOSLAM_FIELD(pause_s, "s", 0.1, 60, "pause between the legs of successive robots");
    RADIOSLAM_FIELD(clearance_m, "m", 0, 5, "smallest distance of a leg from walls and robots");
  }
};

/// One leg of one robot.
struct DriveLeg {
  struct Arc {
    double length_m = 0;
    double curvature_per_m = 0;  ///< positive to the left
  };

  std::size_t robot = 0;
  double begin_s = 0, end_s = 0;
  SE2 T_common_begin;
  double turn_rad = 0;  ///< on the spot, before the arcs
  std::array<Arc, 2> arcs;

  /// Path length, plus the equivalent length of the turn on the spot.
  double effort_m() const;
  /// Pose after this much of the effort.
  SE2 pose_after(double effort_m) const;
  /// Pose at a time; clamped to the leg's start and end.
  SE2 pose_at(double t_s) const;
};

/// Distance of a position from the nearest wall.
using WallDistance = std::function<double(const Eigen::Vector2d& position_m)>;

/// Legs of robots that start at `starts`, in temporal order, the first after a pause. More turns leave the
/// first ones unchanged.
std::vector<DriveLeg> draw_turns(std::vector<SE2> starts, const WallDistance& wall_distance_m,
                                 const TurnDriveParams& params, const Rng& rng);

/// Pose of a robot at a time.
SE2 pose_in_turns(const std::vector<DriveLeg>& legs, std::size_t robot, const SE2& start, double t_s);

}  // namespace radioslam
