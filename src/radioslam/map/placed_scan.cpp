#include "radioslam/map/placed_scan.hpp"

#include <cstdint>
#include <optional>
#include <utility>

namespace radioslam {
namespace {

/// Motion of the body from `stamp` on, along the trajectory's geodesics.
class SweepMotion {
 public:
  SweepMotion(const Trajectory<SE3>& poses, Stamp stamp)
      : poses_(poses), stamp_(stamp), T_body_frame_(poses.at(stamp)->inverse()) {}

  SE3 at(double time_s) const {
    if (poses_.size() < 2) return {};
    const Stamp stamp{stamp_.ns + Stamp::from_seconds(time_s).ns};
    const std::size_t i = poses_.segment(stamp);
    const auto &a = poses_[i], &b = poses_[i + 1];
    const double fraction = seconds_between(a.stamp, stamp) / seconds_between(a.stamp, b.stamp);
    return T_body_frame_ * interpolate(a.pose, b.pose, fraction);
  }

 private:
  const Trajectory<SE3>& poses_;
  Stamp stamp_;
  SE3 T_body_frame_;
};

/// Whether the n-th return of scan k belongs to the share: by a fixed hash of both (splitmix64).
bool is_in_share(std::size_t k, std::size_t n, double share) {
  std::uint64_t x = (static_cast<std::uint64_t>(k) << 32U) + n;
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  x ^= x >> 31U;
  return static_cast<double>(x >> 11U) * 0x1p-53 < share;
}

template <class T>
void keep_share(std::vector<T>& of, std::size_t k, double share) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < of.size(); ++n)
    if (is_in_share(k, n, share)) of[kept++] = of[n];
  of.resize(kept);
}

}  // namespace

MappedRobot mapped_robot(std::string id, LidarLog scans, Trajectory<SE3> poses, const LidarParams& params) {
  MappedRobot robot{std::move(id), std::move(scans), std::move(poses), ScannerKind::kSpatial, {}};
  robot.kind = scanner_traits(robot.scans, params).kind;
  robot.geometry = scanner_geometry(robot.scans, robot.kind, params.points);
  return robot;
}

std::vector<std::size_t> scans_apart(const MappedRobot& robot, double step_m, double step_s) {
  std::vector<std::size_t> chosen;
  std::optional<StampedPose<SE3>> last;
  for (std::size_t k = 0; k < robot.scans.size(); ++k) {
    const Stamp stamp = robot.scans.stamps[k];
    const auto pose = robot.poses.at(stamp);
    if (!pose) continue;
    if (last && seconds_between(last->stamp, stamp) < step_s &&
        (pose->translation() - last->pose.translation()).norm() < step_m)
      continue;
    chosen.push_back(k);
    last = {stamp, *pose};
  }
  return chosen;
}

PlacedScan place_scan(const MappedRobot& robot, std::size_t k, const ScanPointParams& params, double share) {
  const Stamp stamp = robot.scans.stamps[k];
  const SweepMotion motion(robot.poses, stamp);
  LidarScan scan = robot.scans.read(k);
  if (share < 1) {
    keep_share(scan.points, k, share);
    keep_share(scan.times_s, k, share);
    keep_share(scan.intensities, k, share);
  }
  constexpr double kStep_s = 0.05;
  PlacedScan placed;
  placed.stamp = stamp;
  placed.T_frame_body = *robot.poses.at(stamp);
  placed.returns = filter_and_deskew(
      scan, [&](double time_s) { return motion.at(time_s); }, params);
  placed.velocity_mps =
      (motion.at(kStep_s) * robot.geometry.scanner_m - motion.at(-kStep_s) * robot.geometry.scanner_m) /
      (2 * kStep_s);
  return placed;
}

}  // namespace radioslam
