#include "radioslam/sim/worlds/path_ground.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr double kSmallestCell_m = 4;
constexpr double kMaxCells = 1e5;
constexpr double kSmoothing_m = 3;     ///< at the path
constexpr double kFarSmoothing = 0.5;  ///< further away, per distance from the path
constexpr double kDisagreement_m = 1;  ///< of heights, beyond which the lower passage counts

using Places = Eigen::Array<double, Eigen::Dynamic, 3>;

double height_m(const Places& places, const Eigen::Vector2d& position) {
  const Eigen::ArrayXd squared =
      (places.col(0) - position.x()).square() + (places.col(1) - position.y()).square();
  const double variance = kSmoothing_m * kSmoothing_m + kFarSmoothing * kFarSmoothing * squared.minCoeff();
  const Eigen::ArrayXd unlikely = squared / (2 * variance) + places.col(2) / kDisagreement_m;
  const Eigen::ArrayXd weights = (unlikely.minCoeff() - unlikely).exp();
  return (weights * places.col(2)).sum() / weights.sum();
}

}  // namespace

HeightGrid ground_under(const std::vector<Eigen::Vector3d>& path, double reach_m) {
  RADIOSLAM_CHECK(!path.empty(), "a path has a place");
  Places places(static_cast<Eigen::Index>(path.size()), 3);
  for (Eigen::Index k = 0; k < places.rows(); ++k)
    places.row(k) = path[static_cast<std::size_t>(k)].transpose();
  const Eigen::Vector2d low = places.leftCols<2>().colwise().minCoeff().transpose() - reach_m;
  const Eigen::Vector2d high = places.leftCols<2>().colwise().maxCoeff().transpose() + reach_m;
  const Eigen::Vector2d size = high - low;
  const double cell_m = std::max(kSmallestCell_m, std::sqrt(size.prod() / kMaxCells));
  const auto lines = [&](int axis) { return static_cast<Eigen::Index>(size(axis) / cell_m) + 2; };
  const Eigen::MatrixXd heights =
      Eigen::MatrixXd::NullaryExpr(lines(0), lines(1), [&](Eigen::Index i, Eigen::Index j) {
        return height_m(places,
                        low + cell_m * Eigen::Vector2d(static_cast<double>(i), static_cast<double>(j)));
      });
  return {low, cell_m, heights};
}

}  // namespace radioslam
