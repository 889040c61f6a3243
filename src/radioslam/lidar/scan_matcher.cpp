#include "radioslam/lidar/scan_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/lidar/surfels/voxel_grid.hpp"

namespace radioslam {
namespace {

constexpr float kFlat_m = 1e-3F;
}  // namespace

SE3::Tangent twist_between(const ScanOnMap& from, const ScanOnMap& to) {
  const double dt_s = seconds_between(from.middle_stamp, to.middle_stamp);
  return (from.T_map_middle.inverse() * to.T_map_middle).log() / dt_s;
}

void DeskewedScan::deskew_with(const SE3::Tangent& is_per_s) {
  surfels = re_deskew(surfels, times_s, twist_per_s, is_per_s);
  twist_per_s = is_per_s;
}

ScannerTraits scanner_traits(const LidarLog& log, const LidarParams& params) {
  std::vector<LidarScan> scans;
  const std::size_t stride = std::max<std::size_t>(1, (log.size() + kTraitScans - 1) / kTraitScans);
  for (std::size_t k = 0; k < log.size(); k += stride) scans.push_back(log.read(k));
  return scanner_traits(scans, params);
}

ScannerTraits scanner_traits(const std::vector<LidarScan>& scans, const LidarParams& params) {
  std::vector<double> ranges;
  ScannerTraits traits;
  traits.kind = ScannerKind::kPlanar;
  for (const LidarScan& scan : scans) {
    const auto points = filter_and_deskew(scan, SE3::Tangent::Zero(), params.points).points;
    for (const Eigen::Vector3f& point : points) {
      ranges.push_back(static_cast<double>(point.norm()));
      if (std::abs(point.z() - points.front().z()) > kFlat_m) traits.kind = ScannerKind::kSpatial;
    }
  }
  const LidarOdometryParams& odometry = params.odometry;
  traits.spacing_m = odometry.spacing_m > 0 ? odometry.spacing_m
                     : ranges.empty()       ? odometry.max_spacing_m
                                            : std::clamp(odometry.spacing_ratio * upper_median(ranges),
                                                         odometry.min_spacing_m, odometry.max_spacing_m);
  return traits;
}

DeskewedScan ScanMatcher::measure(Stamp stamp, const ScanPoints& points, const SE3::Tangent& twist_per_s,
                                  MotionSource source) const {
  DownsampledPoints thinned = voxel_downsample(points.points, points.times_s, traits_.spacing_m);
  return {stamp,
          source,
          twist_per_s,
          measure_surfels(thinned.points, traits_.spacing_m, traits_.kind, params_.surfel),
          std::move(thinned.times_s),
          points.middle_s};
}

ScanPyramid ScanMatcher::pyramid_of(const DeskewedScan& scan) const {
  return scan_pyramid(scan.surfels, traits_.spacing_m, traits_.kind, params_.map);
}

Registration ScanMatcher::register_near(const LocalMap& map, const ScanPyramid& cloud, const PosePrior& prior,
                                        double deviation_m, double min_correspondence_ratio) const {
  return radioslam::register_near(map, cloud, prior, deviation_m, traits_.kind, params_.registration,
                                  min_correspondence_ratio);
}

Registration ScanMatcher::register_at(const LocalMap& map, const ScanPyramid& cloud, const SE3& start,
                                      const PosePrior& prior, double deviation_m) const {
  return radioslam::register_at(map, cloud, start, prior, deviation_m, traits_.kind, params_.registration);
}

SE3::Jacobian ScanMatcher::observable_information(const SE3::Jacobian& information) const {
  if (traits_.kind == ScannerKind::kSpatial) return information;
  const double sigma_m = params_.odometry.level_sigma_m, sigma_rad = params_.odometry.level_sigma_rad;
  return with_planar_prior(information, 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad));
}

}  // namespace radioslam
