#include "radioslam/sim/turn_drives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kMetresPerRadian = 0.3;  ///< a turn on the spot takes as long as so much way
/// Curvatures of arcs. A straight way would leave open on which side of it a direction lies.
constexpr double kStraightest_per_m = 0.4, kSharpest_per_m = 1.5;
constexpr int kStraightDraws = 10, kDraws = 60;  ///< the first of them without a turn on the spot
constexpr double kCheckStep_m = 0.1;

/// How near the leg comes to a wall or to a robot that stands.
double clearance_m(const DrivenLeg& leg, const std::vector<SE2>& standing,
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

DrivenLeg draw_leg(std::size_t robot, const SE2& begin, bool may_turn, const TurnDriveParams& params,
                   Rng& rng) {
  DrivenLeg leg;
  leg.robot = robot;
  leg.T_common_begin = begin;
  const double turn_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
  if (may_turn) leg.turn_rad = turn_rad;
  const double longest_m = std::max(params.shortest_leg_m, params.longest_leg_m);
  const double length_m = rng.uniform(params.shortest_leg_m, longest_m);
  const double first_share = rng.uniform(0.3, 0.7);
  leg.arcs[0] = {first_share * length_m, draw_curvature_per_m(rng)};
  leg.arcs[1] = {(1 - first_share) * length_m, draw_curvature_per_m(rng)};
  return leg;
}

DrivenLeg clear_leg(std::size_t robot, const std::vector<SE2>& standing, const WallDistance& wall_distance_m,
                    const TurnDriveParams& params, Rng rng) {
  DrivenLeg best;
  double best_m = -1;
  for (int draw = 0; draw < kDraws && best_m < params.clearance_m; ++draw) {
    const DrivenLeg leg = draw_leg(robot, standing[robot], draw >= kStraightDraws, params, rng);
    const double clear_m = clearance_m(leg, standing, wall_distance_m);
    if (clear_m <= best_m) continue;
    best_m = clear_m;
    best = leg;
  }
  return best;
}

}  // namespace

double DrivenLeg::effort_m() const {
  return kMetresPerRadian * std::abs(turn_rad) + arcs[0].length_m + arcs[1].length_m;
}

SE2 DrivenLeg::pose_after(double effort_m) const {
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

SE2 DrivenLeg::pose_at(double t_s) const {
  const double share = std::clamp((t_s - begin_s) / (end_s - begin_s), 0.0, 1.0);
  const double full = 2 * std::numbers::pi;
  return pose_after(effort_m() * (share - std::sin(full * share) / full));
}

std::vector<DrivenLeg> draw_turns(std::vector<SE2> starts, const WallDistance& wall_distance_m,
                                  const TurnDriveParams& params, const Rng& rng) {
  std::vector<SE2> standing = std::move(starts);
  std::vector<DrivenLeg> legs;
  double now_s = params.pause_s;
  const std::size_t turns = standing.size() * static_cast<std::size_t>(params.turns_per_robot);
  for (std::size_t turn = 0; turn < turns; ++turn) {
    DrivenLeg leg = clear_leg(turn % standing.size(), standing, wall_distance_m, params, rng.split(turn));
    leg.begin_s = now_s;
    leg.end_s = now_s + leg.effort_m() / params.mean_speed_mps;
    now_s = leg.end_s + params.pause_s;
    standing[leg.robot] = leg.pose_after(leg.effort_m());
    legs.push_back(leg);
  }
  return legs;
}

SE2 pose_in_turns(const std::vector<DrivenLeg>& legs, std::size_t robot, const SE2& start, double t_s) {
  const auto begun = std::upper_bound(legs.begin(), legs.end(), t_s,
                                      [](double t, const DrivenLeg& leg) { return t < leg.begin_s; });
  const auto last = std::find_if(std::make_reverse_iterator(begun), legs.rend(),
                                 [&](const DrivenLeg& leg) { return leg.robot == robot; });
  return last == legs.rend() ? start : last->pose_at(t_s);
}

}  // namespace radioslam
