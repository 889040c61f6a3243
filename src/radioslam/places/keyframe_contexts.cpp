#include "radioslam/places/keyframe_contexts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radioslam/base/evenly_chosen.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {
namespace {

constexpr double kRangeQuantile = 0.9;    // of the points' ranges: that of the descriptors
constexpr std::size_t kMostRanged = 256;  // keyframes whose points they are, evenly chosen
constexpr double kDriftRatio = 0.02;
constexpr double kMinRange_m = 3, kMaxRange_m = 80;

std::vector<Eigen::Vector3f> points_around(const ScanKeyframes& keyframes, const std::vector<double>& path_m,
                                           std::size_t k, double submap_m) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t n = 0; n < keyframes.poses.size(); ++n) {
    if (n != k && (keyframes.kind == ScannerKind::kSpatial || std::abs(path_m[n] - path_m[k]) > submap_m))
      continue;
    const SE3 T = keyframes.poses[k].inverse() * keyframes.poses[n];
    for (const Surfel& surfel : transformed(T, keyframes.clouds[n].read()->all))
      points.push_back(surfel.position);
  }
  return points;
}

}  // namespace

std::vector<double> path_lengths(const ScanKeyframes& keyframes) {
  const std::vector<SE3>& poses = keyframes.poses;
  std::vector<double> length_m(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    double step_m = (poses[k - 1].inverse() * poses[k]).translation().norm();
    if (k <= keyframes.step_covariances.size()) {
      const SE3::Jacobian& covariance = keyframes.step_covariances[k - 1];
      if (is_unknown_motion(covariance)) step_m += 3 * std::sqrt(covariance.topLeftCorner<3, 3>().trace());
    }
    length_m[k] = length_m[k - 1] + step_m;
  }
  return length_m;
}

double odometry_sigma_m(const ScanKeyframes& keyframes, const std::vector<double>& path_m, std::size_t a,
                        std::size_t b) {
  if (keyframes.step_covariances.size() + 1 < keyframes.poses.size())
    return kDriftRatio * std::abs(path_m[a] - path_m[b]);
  UncertainPose<SE3> motion;
  for (std::size_t k = std::min(a, b); k < std::max(a, b); ++k)
    motion = motion * UncertainPose<SE3>{keyframes.poses[k].inverse() * keyframes.poses[k + 1],
                                         keyframes.step_covariances[k]};
  return std::sqrt(motion.covariance.topLeftCorner<3, 3>().trace() / 3);
}

double context_range(const ScanKeyframes& keyframes) {
  std::vector<float> ranges_m;
  for (const StoredCloud& stored : evenly_chosen(keyframes.clouds, kMostRanged)) {
    const auto cloud = stored.read();
    for (const Surfel& surfel : cloud->all) ranges_m.push_back(surfel.position.head<2>().norm());
  }
  if (ranges_m.empty()) return 0;
  const auto at = ranges_m.begin() +
                  static_cast<std::ptrdiff_t>(kRangeQuantile * static_cast<double>(ranges_m.size() - 1));
  std::nth_element(ranges_m.begin(), at, ranges_m.end());
  return std::clamp(static_cast<double>(*at), kMinRange_m, kMaxRange_m);
}

std::vector<ScanContext> keyframe_contexts(const ScanKeyframes& keyframes, const std::vector<double>& path_m,
                                           double range_m, double submap_m, const ScanContextParams& params) {
  const auto kind =
      keyframes.kind == ScannerKind::kSpatial ? ScanContextKind::kHeight : ScanContextKind::kOccupancy;
  std::vector<std::optional<ScanContext>> made(keyframes.poses.size());
  parallel_for(made.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      made[k] = make_scan_context(points_around(keyframes, path_m, k, submap_m), range_m, kind, params);
  });
  std::vector<ScanContext> contexts;
  for (auto& context : made) contexts.push_back(std::move(*context));
  return contexts;
}

ScanContextIndex keyframe_index(const ScanKeyframes& keyframes, const std::vector<double>& path_m,
                                double range_m, double submap_m, const PlaceDescriptorParams& params) {
  ScanContextIndex index(params.index);
  for (ScanContext& context : keyframe_contexts(keyframes, path_m, range_m, submap_m, params.context))
    index.add(std::move(context));
  index.shrink_to_fit();
  return index;
}

}  // namespace radioslam
