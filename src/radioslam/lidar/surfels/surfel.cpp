#include "radioslam/lidar/surfels/surfel.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/lidar/surfels/point_tree.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxNeighbours = 50;
constexpr std::size_t kMinInPlane = 4;  // three points are always in a plane

/// Covariance of these points about their mean; summed about the first point for numerical accuracy.
Eigen::Matrix3f spread_of(const std::vector<Eigen::Vector3f>& points, const std::size_t* indices,
                          std::size_t count) {
  const Eigen::Vector3f& origin = points[indices[0]];
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (std::size_t k = 1; k < count; ++k) {
    const Eigen::Vector3f offset = points[indices[k]] - origin;
    sum += offset;
    squares.noalias() += offset * offset.transpose();
  }
  const float inverse_count = 1.0F / static_cast<float>(count);
  return inverse_count * squares - inverse_count * inverse_count * sum * sum.transpose();
}

struct SurfelScale {
  std::size_t neighbours, fewest;
  ScannerKind kind;
  float flatness, clearly_flat, variance_along, line_slope_rad2;
  float reach_squared, variance_range, variance_alone;
};

/// Whether the neighbours are a single beam's: in a row, far longer than wide, at less than 45 degrees, and
/// none clearly beside it.
bool is_level_line(const Eigen::Vector3f& variances, const Eigen::Vector3f& longest,
                   const SurfelScale& scale) {
  constexpr float kSin45 = 0.7F;
  const float clearly_across = scale.clearly_flat * std::max(variances(0), scale.variance_range);
  const bool is_row = variances(1) < clearly_across && variances(2) > clearly_across &&
                      variances(2) > scale.clearly_flat * variances(1);
  return is_row && std::abs(longest.z()) < kSin45;
}

/// A beam's line on the ground runs across the line of sight; on a wall alongside it runs away from the
/// scanner.
bool lies_across_view(const Eigen::Vector3f& point, const Eigen::Vector3f& line) {
  constexpr float kCos60 = 0.5F;
  return std::abs(point.head<2>().dot(line.head<2>())) < kCos60 * point.head<2>().norm();
}

Surfel bare_at(const Eigen::Vector3f& point, const SurfelScale& scale) {
  return {point, scale.variance_range * Eigen::Matrix3f::Identity(), 0, SurfelShape::kIsolated};
}

Surfel line_at(const Eigen::Vector3f& point, const SurfelScale& scale) {
  const Eigen::Vector3f level(scale.variance_along, scale.variance_along, scale.variance_range);
  return {point, level.asDiagonal(), scale.line_slope_rad2, SurfelShape::kScanLine};
}

/// A surfel with enlarged variances along its surface, where it hardly constrains motion.
Surfel surface_at(const Eigen::Vector3f& point, const Eigen::Matrix3f& covariance, std::size_t count,
                  const SurfelScale& scale) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes;
  axes.computeDirect(covariance);
  const Eigen::Vector3f variances = axes.eigenvalues().cwiseMax(0.0F);
  const float across = scale.flatness * std::max(variances(0), scale.variance_range);
  Eigen::Vector3f freed = variances.cwiseMax(scale.variance_range);
  if (is_level_line(variances, axes.eigenvectors().col(2), scale))
    return lies_across_view(point, axes.eigenvectors().col(2)) ? line_at(point, scale)
                                                               : bare_at(point, scale);
  const bool is_flat = count >= scale.neighbours && variances(1) > scale.clearly_flat * variances(0);
  for (float& variance : freed) {
    const float ratio = variance / across;
    variance = std::min(variance * (1 + ratio * ratio), std::max(variance, scale.variance_along));
  }
  const float alike = freed(0) / freed(1), n = static_cast<float>(count);
  const float tilt_rad2 =
      (1 - alike) * variances(0) / (n * variances(1)) + alike * variances(1) / (n * variances(2));
  return {point, axes.eigenvectors() * freed.asDiagonal() * axes.eigenvectors().transpose(), tilt_rad2,
          is_flat ? SurfelShape::kSurface : SurfelShape::kUnstructured};
}

Surfel surfel_at(const std::vector<Eigen::Vector3f>& points, const PointTree& tree, std::size_t k,
                 const SurfelScale& scale) {
  std::array<std::size_t, kMaxNeighbours> indices{};
  std::array<float, kMaxNeighbours> squared_distances{};
  std::size_t count = tree.nearest(points[k], scale.neighbours, indices.data(), squared_distances.data());
  while (count > 0 && squared_distances[count - 1] > scale.reach_squared) --count;
  const bool is_planar = scale.kind == ScannerKind::kPlanar;
  const bool is_alone = count < (is_planar ? kMinInPlane : scale.fewest);
  if (is_alone && !is_planar) return bare_at(points[k], scale);
  Eigen::Matrix3f covariance = is_alone ? Eigen::Matrix3f(scale.variance_alone * Eigen::Matrix3f::Identity())
                                        : spread_of(points, indices.data(), count);
  covariance.diagonal().array() += scale.variance_range;
  if (!is_planar) return surface_at(points[k], covariance, count, scale);
  covariance(2, 2) += scale.variance_alone;
  return {points[k], covariance};
}

}  // namespace

Surfel transformed(const Eigen::Matrix3f& R, const Eigen::Vector3f& t, const Surfel& surfel) {
  return {R * surfel.position + t, R * surfel.covariance * R.transpose(), surfel.tilt_rad2, surfel.shape};
}

std::vector<Surfel> measure_surfels(const std::vector<Eigen::Vector3f>& points, double spacing_m,
                                    ScannerKind kind, const SurfelParams& params) {
  RADIOSLAM_CHECK(params.neighbours <= static_cast<int>(kMaxNeighbours),
                  "the number of neighbours is limited");
  if (points.empty()) return {};
  const PointTree tree(points);
  const double max_distance_m = params.max_distance_spacings * spacing_m;
  const SurfelScale scale{static_cast<std::size_t>(params.neighbours),
                          static_cast<std::size_t>(std::min(params.min_neighbours, params.neighbours)),
                          kind,
                          static_cast<float>(params.flatness),
                          static_cast<float>(params.clearly_flat),
                          static_cast<float>(params.sigma_along_m * params.sigma_along_m),
                          static_cast<float>(params.line_slope_rad * params.line_slope_rad),
                          static_cast<float>(max_distance_m * max_distance_m),
                          static_cast<float>(params.sigma_range_m * params.sigma_range_m),
                          static_cast<float>(spacing_m * spacing_m)};
  std::vector<Surfel> surfels(points.size());
  constexpr std::size_t kGrain = 256;
  parallel_for(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) surfels[k] = surfel_at(points, tree, k, scale);
  });
  return surfels;
}

}  // namespace radioslam
