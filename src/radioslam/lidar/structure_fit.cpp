#include "radioslam/lidar/structure_fit.hpp"

#include <Eigen/LU>

namespace radioslam {
namespace {

bool has_normal(const Surfel& surfel) { return surfel.shape >= SurfelShape::kUnstructured; }

}  // namespace

double horizontal_share(const Surfel& surfel) {
  if (!has_normal(surfel)) return 0;
  const Eigen::Matrix3d information = surfel.covariance.cast<double>().inverse();
  return (information(0, 0) + information(1, 1)) / information.trace();
}

double structure_of(const ScanPyramid& scan) {
  double sum = 0;
  for (const Surfel& surfel : scan.source.surfels) sum += horizontal_share(surfel);
  return sum;
}

double structure_fit(const SurfelColumns& map, const ScanPyramid& scan, const SE3& T_map_scan,
                     ScannerKind kind, double loss_scale) {
  const Eigen::Matrix3f R = T_map_scan.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = T_map_scan.translation().cast<float>();
  const auto max_distance_m = static_cast<float>(map.max_distance_m());
  const double squared_scale = loss_scale * loss_scale;
  double structure = 0, fitting = 0;
  for (const Surfel& surfel : scan.source.surfels) {
    const double share = kind == ScannerKind::kPlanar ? 1 : horizontal_share(surfel);
    if (share == 0) continue;
    structure += share;
    const Surfel moved = transformed(R, t, surfel);
    const Surfel* nearest = map.nearest(moved.position, max_distance_m * max_distance_m);
    if (!nearest || (kind == ScannerKind::kSpatial && !has_normal(*nearest))) continue;
    const Eigen::Vector3f offset = nearest->position - moved.position;
    Eigen::Matrix3f covariance = nearest->covariance + moved.covariance;
    covariance.diagonal().array() += 0.25F * (nearest->tilt_rad2 + moved.tilt_rad2) * offset.squaredNorm();
    const double squares = static_cast<double>(offset.dot(covariance.inverse() * offset));
    const double root = squared_scale / (squared_scale + squares);
    fitting += share * root * root;
  }
  return structure > 0 ? fitting / structure : 0;
}

}  // namespace radioslam
