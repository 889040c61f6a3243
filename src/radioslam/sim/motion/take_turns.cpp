#include "radioslam/sim/motion/take_turns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kMetresPerRadian = 0.3;  ///< path length that takes as long as a turn on the spot
/// Range of the arcs' curvature. A straight path would leave the side of a direction ambiguous.
constexpr double kStraightest_per_m = 0.4, kSharpest_per_m = 1.5;
constexpr int kStraightDraws = 10, kDraws = 60;  ///< the first of these draws have no turn on the spot
constexpr double kCheckStep_m = 0.1;

/// Smallest distance of the leg to a wall or to a robot at rest.
double clearance_m(const DriveLeg& leg, const std::vector<SE2>& standing,
                   const WallDistance& wall_distance_m) {
  double least = std::numeric_limits<double>::infinity();
  for (double effort = 0; effort < leg.effort_m() + kCheckStep_m; effort += kCheckStep_m) {
    const Eigen::Vector2d place = leg.pose_after(std::min(effort, leg.effort_m())).translation();
    least = std::min(least, wall_distance_m(place));
    for (std::size_t r = 0; r < standing.size(); ++r)
      if (r != leg.robot) least = std::min(least, (standing[r].translation() - place).norm());
  }
  return least;
}

double draw_curvature_per_m(Rng& rng) {
  const double side = rng.uniform() < 0.5 ? -1 : 1;
  return side * rng.uniform(kStraightest_per_m, kSharpest_per_m);
}

DriveLeg draw_leg(std::size_t robot, const SE2& begin, bool may_turn, const TurnDriveParams& params,
                  Rng& rng) {
  DriveLeg leg;
  leg.robot = robot;
  leg.T_common_begin = begin;
  const double turn_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
  if (may_turn) leg.turn_rad = turn_rad;
  const double max_m = std::max(params.min_leg_m, params.max_leg_m);
  const double length_m = rng.uniform(params.min_leg_m, max_m);
  const double first_ratio = rng.uniform(0.3, 0.7);
  leg.arcs[0] = {first_ratio * length_m, draw_curvature_per_m(rng)};
  leg.arcs[1] = {(1 - first_ratio) * length_m, draw_curvature_per_m(rng)};
  return leg;
}

DriveLeg clear_leg(std::size_t robot, const std::vector<SE2>& standing, const WallDistance& wall_distance_m,
                   const TurnDriveParams& params, Rng rng) {
  DriveLeg best;
  double best_m = -1;
  for (int draw = 0; draw < kDraws && best_m < params.clearance_m; ++draw) {
    const DriveLeg leg = draw_leg(robot, standing[robot], draw >= kStraightDraws, params, rng);
    const double clear_m = clearance_m(leg, standing, wall_distance_m);
    if (clear_m <= best_m) continue;
    best_m = clear_m;
    best = leg;
  }
  return best;
}

}  // namespace

double DriveLeg::effort_m() const {
  return kMetresPerRadian * std::abs(turn_rad) + arcs[0].length_m + arcs[1].length_m;
}

SE2 DriveLeg::pose_after(double effort_m) const {
  const double turn_m = kMetresPerRadian * std::abs(turn_rad);
  if (effort_m < turn_m) return T_common_begin * SE2({0, 0}, turn_rad * effort_m / turn_m);
  SE2 pose = T_common_begin * SE2({0, 0}, turn_rad);
  double left_m = effort_m - turn_m;
  for (const Arc& arc : arcs) {
    const double way_m = std::min(left_m, arc.length_m);
    pose = pose * SE2::exp({way_m, 0, arc.curvature_per_m * way_m});
    left_m -= way_m;
  }
  return pose;
}

SE2 DriveLeg::pose_at(double t_s) const {
  const double ratio = std::clamp((t_s - begin_s) / (end_s - begin_s), 0.0, 1.0);
  const double full = 2 * std::numbers::pi;
  return pose_after(effort_m() * (ratio - std::sin(full * ratio) / full));
}

std::vector<DriveLeg> draw_turns(std::vector<SE2> starts, const WallDistance& wall_distance_m,
                                 const TurnDriveParams& params, const Rng& rng) {
  std::vector<SE2> standing = std::move(starts);
  std::vector<DriveLeg> legs;
  double now_s = params.pause_s;
  const std::size_t turns = standing.size() * static_cast<std::size_t>(params.turns_per_robot);
  for (std::size_t turn = 0; turn < turns; ++turn) {
    DriveLeg leg = clear_leg(turn % standing.size(), standing, wall_distance_m, params, rng.split(turn));
    leg.begin_s = now_s;
    leg.end_s = now_s + leg.effort_m() / params.mean_speed_mps;
    now_s = leg.end_s + params.pause_s;
    standing[leg.robot] = leg.pose_after(leg.effort_m());
    legs.push_back(leg);
  }
  return legs;
}

SE2 pose_in_turns(const std::vector<DriveLeg>& legs, std::size_t robot, const SE2& start, double t_s) {
  const auto begun = std::upper_bound(legs.begin(), legs.end(), t_s,
                                      [](double t, const DriveLeg& leg) { return t < leg.begin_s; });
  const auto last = std::find_if(std::make_reverse_iterator(begun), legs.rend(),
                                 [&](const DriveLeg& leg) { return leg.robot == robot; });
  return last == legs.rend() ? start : last->pose_at(t_s);
}

}  // namespace radioslam
