#include "radioslam/sim/motion/drive.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {
namespace {

constexpr double kMinWave_m = 12;
constexpr double kMaxWave_m = 40;
constexpr double kStraight_rad = 1e-9;  ///< smaller turns are straight
constexpr double kRouteMargin = 1.25;   ///< arcs cut corners and shorten the path, by less than a fifth
constexpr double kMaxCutRatio = 0.45;   ///< of a lane that the corner at one end may use

using LaneUse = std::map<std::pair<std::size_t, std::size_t>, int>;

int& uses(LaneUse& use, std::size_t i, std::size_t j) { return use[std::minmax(i, j)]; }

std::size_t draw_next(const std::vector<std::size_t>& choices, std::size_t here, LaneUse& use, Rng& rng) {
  double total = 0;
  for (const std::size_t next : choices) total += 1.0 / (1 + uses(use, here, next));
  double left = rng.uniform() * total;
  for (const std::size_t next : choices) {
    left -= 1.0 / (1 + uses(use, here, next));
    if (left < 0) return next;
  }
  return choices.back();
}

double direction_rad(const Eigen::Vector2d& offset) { return std::atan2(offset.y(), offset.x()); }

constexpr std::size_t kParts = 4;  ///< of a mission, in each of which robots should be in range

Trajectory<SE3> draw_trajectory(const LaneGrid& lanes, const Hills& ground, const TeamDriveParams& params,
                                const Rng& rng) {
  const std::size_t start = rng.split("start").below(lanes.size());
  const auto corners = draw_corners(lanes, start, params.drive.path_length_m, rng.split("route"));
  const Drive drive(corners, params.drive, rng.split("wander"));
  const double end_s = params.drive.path_length_m / params.drive.speed_mps;
  std::vector<StampedPose<SE3>> poses;
  for (const Stamp stamp : regular_stamps(0, end_s, params.rate_hz))
    poses.push_back({stamp, ground.pose_on_ground(drive.pose_at(params.drive.speed_mps * stamp.seconds()))});
  return Trajectory<SE3>(std::move(poses));
}

/// Number of poses at which two robots are in range, counting at most wanted / kParts in each part of the
/// mission: `wanted` if there are enough in every part. Both trajectories have the same stamps.
std::size_t spread_contact(const Trajectory<SE3>& a, const Trajectory<SE3>& b, double range_m,
                           std::size_t wanted) {
  std::array<std::size_t, kParts> poses{};
  const std::size_t size = std::min(a.size(), b.size());
  for (std::size_t k = 0; k < size; ++k)
    if ((a[k].pose.translation() - b[k].pose.translation()).norm() <= range_m) ++poses[kParts * k / size];
  std::size_t total = 0;
  for (const std::size_t count : poses) total += std::min(count, wanted / kParts);
  return total;
}

/// The largest such number of a robot with any of the others.
std::size_t best_contact(const Trajectory<SE3>& trajectory, const std::vector<Trajectory<SE3>>& others,
                         double range_m, std::size_t wanted) {
  std::size_t best = 0;
  for (const auto& other : others) best = std::max(best, spread_contact(trajectory, other, range_m, wanted));
  return best;
}

}  // namespace

std::vector<std::size_t> draw_route(const LaneGrid& lanes, std::size_t start, double length_m, Rng rng) {
  std::vector<std::size_t> route{start};
  LaneUse use;
  for (double path_m = 0; path_m < length_m;) {
    const std::size_t here = route.back();
    std::vector<std::size_t> choices = lanes.neighbours(here);
    if (route.size() > 1) std::erase(choices, route[route.size() - 2]);
    RADIOSLAM_CHECK(!choices.empty(), "every crossing has a lane to continue on");
    const std::size_t next = draw_next(choices, here, use, rng);
    ++uses(use, here, next);
    path_m += (lanes.crossing(next) - lanes.crossing(here)).norm();
    route.push_back(next);
  }
  return route;
}

std::vector<Eigen::Vector2d> draw_corners(const LaneGrid& lanes, std::size_t start, double path_length_m,
                                          const Rng& rng) {
  std::vector<Eigen::Vector2d> corners;
  for (const std::size_t i : draw_route(lanes, start, kRouteMargin * path_length_m, rng))
    corners.push_back(lanes.crossing(i));
  return corners;
}

Drive::Drive(const std::vector<Eigen::Vector2d>& corners, const DriveParams& params, Rng rng) {
  RADIOSLAM_CHECK(corners.size() >= 2, "a drive needs two corners");
  append(SE2(corners[0], direction_rad(corners[1] - corners[0])), 0, 0);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Eigen::Vector2d before = corners[i] - corners[i - 1];
    const Eigen::Vector2d after = i + 1 < corners.size() ? corners[i + 1] - corners[i] : before;
    const double turn_rad = wrap_angle(direction_rad(after) - direction_rad(before));
    const double tangent = std::tan(std::abs(turn_rad) / 2);
    const double cut_m =
        std::min(params.corner_radius_m * tangent, kMaxCutRatio * std::min(before.norm(), after.norm()));
    append_line_to(corners[i] - cut_m * before.normalized());
    if (std::abs(turn_rad) > kStraight_rad) append_corner(turn_rad, cut_m / tangent);
  }
  for (auto& wave : waves_) {
    wave.amplitude_m = params.sigma_wander_m * std::sqrt(2.0 / static_cast<double>(waves_.size()));
    wave.wavenumber_per_m = 2 * std::numbers::pi / rng.uniform(kMinWave_m, kMaxWave_m);
    wave.phase_rad = rng.uniform(0, 2 * std::numbers::pi);
  }
}

SE2 Drive::pose_at(double path_m) const {
  const auto after =
      std::upper_bound(segments_.begin(), segments_.end(), path_m,
                       [](double offset, const PathSegment& segment) { return offset < segment.begin_m; });
  const PathSegment& segment = after == segments_.begin() ? *after : *std::prev(after);
  const double along_m = path_m - segment.begin_m;
  const SE2 on_line = segment.T_floor_begin * SE2::exp({along_m, 0, segment.curvature_per_m * along_m});
  double aside_m = 0, slope = 0;
  for (const auto& wave : waves_) {
    const double angle = wave.wavenumber_per_m * path_m + wave.phase_rad;
    aside_m += wave.amplitude_m * std::sin(angle);
    slope += wave.amplitude_m * wave.wavenumber_per_m * std::cos(angle);
  }
  // Tangent of the line shifted sideways by a(s): (1 - curvature a, a').
  return on_line * SE2({0, aside_m}, std::atan2(slope, 1 - segment.curvature_per_m * aside_m));
}

void Drive::append(const SE2& T_floor_begin, double length_m, double curvature_per_m) {
  segments_.push_back({length_m_, length_m, T_floor_begin, curvature_per_m});
  length_m_ += length_m;
}

void Drive::append_line_to(const Eigen::Vector2d& target) {
  const PathSegment& last = segments_.back();
  const SE2 begin = last.T_floor_begin * SE2::exp({last.length_m, 0, last.curvature_per_m * last.length_m});
  append(begin, (target - begin.translation()).norm(), 0);
}

void Drive::append_corner(double turn_rad, double radius_m) {
  const PathSegment& last = segments_.back();
  const SE2 begin = last.T_floor_begin * SE2({last.length_m, 0}, 0);
  append(begin, radius_m * std::abs(turn_rad), std::copysign(1 / radius_m, turn_rad));
}

std::vector<Trajectory<SE3>> drive_team(const LaneGrid& lanes, const Hills& ground,
                                        const TeamDriveParams& params, const Rng& rng) {
  const std::size_t wanted =
      kParts * static_cast<std::size_t>(params.min_contact_s * params.rate_hz / static_cast<double>(kParts));
  std::vector<Trajectory<SE3>> team;
  for (std::size_t r = 0; r < static_cast<std::size_t>(params.robots); ++r) {
    const Rng own = rng.split("drives").split(r);
    Trajectory<SE3> best = draw_trajectory(lanes, ground, params, own.split(std::uint64_t{0}));
    std::size_t longest = best_contact(best, team, params.contact_range_m, wanted);
    for (std::uint64_t draw = 1; r > 0 && longest < wanted && draw < static_cast<std::uint64_t>(params.draws);
         ++draw) {
      auto next = draw_trajectory(lanes, ground, params, own.split(draw));
      const std::size_t contact = best_contact(next, team, params.contact_range_m, wanted);
      if (contact <= longest) continue;
      longest = contact;
      best = std::move(next);
    }
    team.push_back(std::move(best));
  }
  return team;
}

}  // namespace radioslam
