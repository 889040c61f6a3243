#include "radioslam/lidar/scan_structure.hpp"

#include <algorithm>
#include <array>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/lidar/surfels/point_tree.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxAround = 50;

Eigen::Matrix3d spread_about_mean(const std::vector<Eigen::Vector3f>& points,
                                  const std::array<std::size_t, kMaxAround>& indices, std::size_t count) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) mean += points[indices[k]].cast<double>();
  mean /= static_cast<double>(count);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d offset = points[indices[k]].cast<double>() - mean;
    spread += offset * offset.transpose();
  }
  return spread;
}

bool is_elongated(const Eigen::Matrix3d& spread, ScannerKind kind, double elongation) {
  if (kind == ScannerKind::kPlanar) {
    const auto squares = symmetric_eigenvalues<Eigen::Matrix2d>(spread.topLeftCorner<2, 2>());
    return squares(1) > elongation * squares(0);
  }
  const auto squares = symmetric_eigenvalues(spread);
  return squares(2) > elongation * squares(0);
}

}  // namespace

double planarity(const std::vector<Surfel>& surfels, ScannerKind kind, const ScanStructureParams& params) {
  const auto neighbours =
      static_cast<std::size_t>(params.neighbours / (kind == ScannerKind::kPlanar ? 2 : 1));
  RADIOSLAM_CHECK(neighbours <= kMaxAround, "the number of neighbours is limited");
  if (surfels.size() < 2 * neighbours) return 0;
  std::vector<Eigen::Vector3f> points;
  points.reserve(surfels.size());
  for (const Surfel& surfel : surfels) points.push_back(surfel.position);
  const PointTree tree(points);
  const std::size_t stride =
      std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(params.max_points));
  std::size_t looked = 0, elongated = 0;
  for (std::size_t k = 0; k < points.size(); k += stride, ++looked) {
    std::array<std::size_t, kMaxAround> indices{};
    std::array<float, kMaxAround> squared_distances{};
    const std::size_t count = tree.nearest(points[k], neighbours, indices.data(), squared_distances.data());
    if (is_elongated(spread_about_mean(points, indices, count), kind, params.elongation)) ++elongated;
  }
  return static_cast<double>(elongated) / static_cast<double>(looked);
}

bool StructureGate::admits(const std::vector<Surfel>& scan) {
  const bool is_structured = planarity(scan, kind_, params_) >= params_.min_structured_ratio;
  unstructured_ = is_structured ? 0 : std::min(unstructured_ + 1, max_rejected_ + 1);
  return unstructured_ == 0 || unstructured_ > max_rejected_;
}

}  // namespace radioslam
