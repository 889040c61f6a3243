#include "radioslam/lidar/scan_matcher.hpp"

#include <utility>

#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/lidar/surfels/voxel_grid.hpp"

namespace radioslam {

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
