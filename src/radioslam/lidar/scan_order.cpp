#include "radioslam/lidar/scan_order.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "radioslam/base/check.hpp"
#include "radioslam/lidar/point_tree.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostAround = 50;

Eigen::Matrix3d spread_about_mean(const std::vector<Eigen::Vector3f>& points,
                                  const std::array<std::size_t, kMostAround>& indices, std::size_t count) {
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
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread.topLeftCorner<2, 2>(),
                                                              Eigen::EigenvaluesOnly);
    return axes.eigenvalues()(1) > elongation * axes.eigenvalues()(0);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()(2) > elongation * axes.eigenvalues()(0);
}

}  // namespace

double scan_order(const std::vector<Surfel>& surfels, ScannerKind kind, const ScanOrderParams& params) {
  const auto neighbours =
      static_cast<std::size_t>(params.neighbours / (kind == ScannerKind::kPlanar ? 2 : 1));
  RADIOSLAM_CHECK(neighbours <= kMostAround, "no more neighbours than that");
  if (surfels.size() < 2 * neighbours) return 0;
  std::vector<Eigen::Vector3f> points;
  points.reserve(surfels.size());
  for (const Surfel& surfel : surfels) points.push_back(surfel.position);
  const PointTree tree(points);
  const std::size_t stride =
      std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(params.most_points));
  std::size_t looked = 0, elongated = 0;
  for (std::size_t k = 0; k < points.size(); k += stride, ++looked) {
    std::array<std::size_t, kMostAround> indices{};
    std::array<float, kMostAround> squared_distances{};
    const std::size_t count = tree.nearest(points[k], neighbours, indices.data(), squared_distances.data());
    if (is_elongated(spread_about_mean(points, indices, count), kind, params.elongation)) ++elongated;
  }
  return static_cast<double>(elongated) / static_cast<double>(looked);
}

}  // namespace radioslam
