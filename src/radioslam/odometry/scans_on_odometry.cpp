#include "radioslam/odometry/scans_on_odometry.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/stamp_intervals.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kTrials = 20, kBefore = 5;  // registrations; keyframes of their maps
constexpr double kMinNominal = 0.6;   // inlier ratio below which steps were too uncertain to measure it
constexpr double kDeviation_m = 0.3;  // of a keyframe from its place among those before

/// Body twist per second over a scan that begins at `stamp`.
SE3::Tangent twist_at(const Trajectory<SE3>& odometry, Stamp stamp, double scan_s) {
  const auto begin = odometry.at(stamp), end = odometry.at(Stamp{stamp.ns + Stamp::from_seconds(scan_s).ns});
  if (!begin || !end || scan_s <= 0) return SE3::Tangent::Zero();
  return (begin->inverse() * *end).log() / scan_s;
}

/// Median inlier ratio of keyframes on the map of those before, as far as their steps let them be registered.
double nominal_inlier_ratio(const ScanKeyframes& of, const ScanMatcher& matcher) {
  const std::size_t count = of.poses.size();
  const std::size_t stride = std::max<std::size_t>(1, count / kTrials);
  std::vector<double> ratios;
  for (std::size_t k = kBefore; k < count; k += stride) {
    LocalMap map = matcher.empty_map();
    for (std::size_t n = k - kBefore; n < k; ++n) map.add(*of.clouds[n].read(), of.poses[n], 0);
    PosePrior prior{of.poses[k]};
    prior.information = isotropic(1 / (kDeviation_m * kDeviation_m), 100);
    const Registration fit = matcher.register_near(map, *of.clouds[k].read(), prior, kDeviation_m);
    if (fit.end == RegistrationStatus::kConverged) ratios.push_back(fit.inlier_ratio);
  }
  return std::max(kMinNominal, ratios.empty() ? 1 : upper_median(std::move(ratios)));
}

/// Keyframes whose scan has no usable points.
void drop_empty(ScansOnOdometry& scans) {
  std::size_t kept = 0;
  ScanKeyframes& of = scans.keyframes;
  for (std::size_t k = 0; k < of.clouds.size(); ++k) {
    if (of.clouds[k].empty()) continue;
    std::swap(of.clouds[kept], of.clouds[k]);
    of.poses[kept] = of.poses[k];
    scans.stamps[kept++] = scans.stamps[k];
  }
  of.clouds.resize(kept);
  of.poses.resize(kept);
  scans.stamps.resize(kept);
}

}  // namespace

ScansOnOdometry scans_on_odometry(const Robot& robot, const ScannerTraits& traits, const LidarParams& params,
                                  const KeyframeParams& keyframes, CloudStore& clouds) {
  ScansOnOdometry result;
  ScanKeyframes& scans = result.keyframes;
  scans.spacing_m = traits.spacing_m;
  scans.kind = traits.kind;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < robot.lidar.size(); ++k) {
    const auto pose = robot.odometry.at(robot.lidar.stamps[k]);
    if (!pose || (!chosen.empty() && !is_new_keyframe(scans.poses.back(), *pose, keyframes))) continue;
    chosen.push_back(k);
    scans.poses.push_back(*pose);
    result.stamps.push_back(robot.lidar.stamps[k]);
  }
  const ScanMatcher matcher(traits, params);
  const double scan_s = median_interval_s(robot.lidar.stamps);
  scans.clouds.resize(chosen.size());
  parallel_for(chosen.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Stamp stamp = result.stamps[n];
      const SE3::Tangent twist = twist_at(robot.odometry, stamp, scan_s);
      const ScanPoints points = filter_and_deskew(robot.lidar.read(chosen[n]), twist, params.points);
      scans.clouds[n] =
          clouds.add(matcher.pyramid_of(matcher.measure(stamp, points, twist, MotionSource::kOdometry)));
    }
  });
  drop_empty(result);
  scans.nominal_inlier_ratio = nominal_inlier_ratio(scans, matcher);
  return result;
}

}  // namespace radioslam
