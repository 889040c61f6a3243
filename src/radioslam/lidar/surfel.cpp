#include "radioslam/lidar/surfel.hpp"

#include <array>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/lidar/point_tree.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostNeighbours = 50;
constexpr std::size_t kFewestNeighbours = 4;  // three always lie in a plane

struct ItselfPosition {
  const Eigen::Vector3f& operator()(const Eigen::Vector3f& point) const { return point; }
};
using CloudTree = PointTree<Eigen::Vector3f, ItselfPosition>;

/// Covariance of these points about their mean, summed about the first for the sake of the digits.
Eigen::Matrix3f spread_of(const std::vector<Eigen::Vector3f>& points, const std::size_t* indices,
                          std::size_t count) {
  const Eigen::Vector3f origin = points[indices[0]];
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (std::size_t k = 1; k < count; ++k) {
    const Eigen::Vector3f offset = points[indices[k]] - origin;
    sum += offset;
    squares.noalias() += offset * offset.transpose();
  }
  const float share = 1.0F / static_cast<float>(count);
  return share * squares - share * share * sum * sum.transpose();
}

struct SurfelScale {
  std::size_t neighbours;
  float reach_squared, variance_range, variance_alone;
};

Surfel surfel_at(const std::vector<Eigen::Vector3f>& points, const CloudTree& tree, std::size_t k,
                 const SurfelScale& scale, ScannerKind kind) {
  std::array<std::size_t, kMostNeighbours> indices{};
  std::array<float, kMostNeighbours> squared_distances{};
  std::size_t count = tree.nearest(points[k], scale.neighbours, indices.data(), squared_distances.data());
  while (count > 0 && squared_distances[count - 1] > scale.reach_squared) --count;
  Surfel surfel{points[k], Eigen::Matrix3f::Zero()};
  if (count >= kFewestNeighbours)
    surfel.covariance = spread_of(points, indices.data(), count);
  else
    surfel.covariance.diagonal().setConstant(scale.variance_alone);
  surfel.covariance.diagonal().array() += scale.variance_range;
  if (kind == ScannerKind::kPlanar) surfel.covariance(2, 2) += scale.variance_alone;
  return surfel;
}

}  // namespace

std::vector<Surfel> measure_surfels(const std::vector<Eigen::Vector3f>& points, double spacing_m,
                                    ScannerKind kind, const SurfelParams& params) {
  RADIOSLAM_CHECK(params.neighbours <= static_cast<int>(kMostNeighbours), "no more neighbours than that");
  if (points.empty()) return {};
  const CloudTree tree(points);
  const double reach = params.reach_spacings * spacing_m;
  const SurfelScale scale{static_cast<std::size_t>(params.neighbours), static_cast<float>(reach * reach),
                          static_cast<float>(params.sigma_range_m * params.sigma_range_m),
                          static_cast<float>(spacing_m * spacing_m)};
  std::vector<Surfel> surfels(points.size());
  constexpr std::size_t kGrain = 256;
  parallel_for(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) surfels[k] = surfel_at(points, tree, k, scale, kind);
  });
  return surfels;
}

}  // namespace radioslam
