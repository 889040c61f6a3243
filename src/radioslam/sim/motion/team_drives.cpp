#include "radioslam/sim/motion/team_drives.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {
namespace {

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
