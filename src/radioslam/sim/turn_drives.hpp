// Robots that take turns: one drives a short way while all others stand still.
//
// A leg is a turn on the spot, none where there is way enough ahead, and two arcs of curvatures of their own.
// It starts and ends gently: the way covered after the share u of its time is u - sin(2 pi u) / (2 pi) of the
// whole. Legs are drawn until one keeps clear of walls and robots; where none does, that which keeps clearest
// stands. After a leg and a pause it is the next robot's turn.
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
  double shortest_leg_m = 1;
  double longest_leg_m = 2;
  double mean_speed_mps = 0.2;
  double pause_s = 1;
  double clearance_m = 0.8;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"turns_per_robot", "", 0, 1000, "legs of each robot"}, self.turns_per_robot);
    visit(Field{"shortest_leg_m", "m", 0.1, 20, "way of a leg, at least"}, self.shortest_leg_m);
    visit(Field{"longest_leg_m", "m", 0.1, 20, "and at most"}, self.longest_leg_m);
    visit(Field{"mean_speed_mps", "m/s", 0.02, 2, "over a leg; twice that in its middle"},
          self.mean_speed_mps);
    visit(Field{"pause_s", "s", 0.1, 60, "between one robot's leg and the next one's"}, self.pause_s);
    visit(Field{"clearance_m", "m", 0, 5, "of the way from walls and robots"}, self.clearance_m);
  }
};

/// One robot's turn.
struct DrivenLeg {
  struct Arc {
    double length_m = 0;
    double curvature_per_m = 0;  ///< positive to the left
  };

  std::size_t robot = 0;
  double begin_s = 0, end_s = 0;
  SE2 T_common_begin;
  double turn_rad = 0;  ///< on the spot, before the arcs
  std::array<Arc, 2> arcs;

  /// The way and what the turn on the spot counts for.
  double effort_m() const;
  /// After this much of the effort.
  SE2 pose_after(double effort_m) const;
  /// The begin before it, the end after it.
  SE2 pose_at(double t_s) const;
};

/// How far a place is from the nearest wall.
using WallDistance = std::function<double(const Eigen::Vector2d& place_m)>;

/// The legs of robots that stand at `starts`, in the order of time, the first after a pause. The same first
/// turns for more of them.
std::vector<DrivenLeg> draw_turns(std::vector<SE2> starts, const WallDistance& wall_distance_m,
                                  const TurnDriveParams& params, const Rng& rng);

/// Where a robot is at a time.
SE2 pose_in_turns(const std::vector<DrivenLeg>& legs, std::size_t robot, const SE2& start, double t_s);

}  // namespace radioslam
