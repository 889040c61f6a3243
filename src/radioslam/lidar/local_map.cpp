#include "radioslam/lidar/local_map.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/lidar/surfels/voxel_grid.hpp"

namespace radioslam {

namespace {

/// Points within one correlation distance together count as one: by area on a surface, by length on a planar
/// scan line.
double effective_sample_ratio(double apart_m, double correlation_m, ScannerKind kind) {
  const double along = std::min(1.0, apart_m / std::max(correlation_m, 1e-9));
  return kind == ScannerKind::kPlanar ? along : along * along;
}

}  // namespace

ScanPyramid scan_pyramid(std::vector<Surfel> surfels, double spacing_m, ScannerKind kind,
                         const LocalMapParams& params) {
  ScanPyramid cloud;
  std::vector<double> ranges;
  for (const Surfel& surfel : surfels) ranges.push_back(static_cast<double>(surfel.position.norm()));
  if (!ranges.empty()) cloud.median_range_m = upper_median(std::move(ranges));
  const double correlation_m = params.correlation_ratio * cloud.median_range_m;
  const auto source = [&](double spacings) {
    const double apart_m = spacings * spacing_m;
    return SurfelSource{voxel_first(surfels, apart_m), effective_sample_ratio(apart_m, correlation_m, kind)};
  };
  cloud.source = source(params.source_spacings);
  cloud.few = source(params.coarse_spacings);
  cloud.all = std::move(surfels);
  return cloud;
}

std::vector<Surfel> transformed(const SE3& T, const std::vector<Surfel>& surfels) {
  const Eigen::Matrix3f R = T.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  std::vector<Surfel> moved;
  moved.reserve(surfels.size());
  for (const Surfel& surfel : surfels) moved.push_back(transformed(R, t, surfel));
  return moved;
}

LocalMap::LocalMap(double spacing_m, const LocalMapParams& params)
    : memory_m_(params.memory_m),
      fine_(spacing_m, params.max_distance_spacings * spacing_m),
      coarse_(params.coarse_spacings * spacing_m, params.coarse_max_distance_spacings * spacing_m) {}

double LocalMap::add(const ScanPyramid& cloud, const SE3& T_map_body, double travelled_m) {
  const std::vector<Surfel> surfels = transformed(T_map_body, cloud.all);
  const std::size_t taken = fine_.add(surfels, travelled_m);
  coarse_.add(surfels, travelled_m);
  fine_.forget_before(travelled_m - memory_m_);
  coarse_.forget_before(travelled_m - memory_m_);
  return static_cast<double>(taken) / static_cast<double>(std::max<std::size_t>(1, surfels.size()));
}

}  // namespace radioslam
