#include "radioslam/radio/ranging/anchor_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

using Eigen::Index;

constexpr int kMaxDampedSteps = 200;
constexpr double kFirstDamping = 1e-3;  // Levenberg-Marquardt, relative to the mean information
constexpr double kMinDamping = 1e-9;    // holds the gauge: translation and rotation
constexpr double kMaxDamping = 1e9;
constexpr double kSettled = 1e-12;  // relative decrease of chi-squared at convergence

/// Distance matrix completed by shortest paths (Floyd and Warshall); repeated measurements are averaged.
Eigen::MatrixXd completed(std::size_t points, const std::vector<AnchorDistance>& distances,
                          const std::vector<bool>& used) {
  const auto n = static_cast<Index>(points);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n), count = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (!used[k]) continue;
    const auto i = static_cast<Index>(distances[k].i), j = static_cast<Index>(distances[k].j);
    sum(i, j) += distances[k].distance_m, sum(j, i) += distances[k].distance_m;
    ++count(i, j), ++count(j, i);
  }
  Eigen::MatrixXd path =
      (count.array() > 0)
          .select(sum.cwiseQuotient(count.cwiseMax(1)),
                  Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity()));
  path.diagonal().setZero();
  const Eigen::MatrixXd measured = path;
  for (Index k = 0; k < n; ++k)
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) path(i, j) = std::min(path(i, j), path(i, k) + path(k, j));
  return measured.array().isFinite().select(measured, path);
}

Eigen::MatrixXd classical_scaling(const Eigen::MatrixXd& distances, int dimension) {
  const Index n = distances.rows();
  const Eigen::MatrixXd centring =
      Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
  const Eigen::MatrixXd gram = -0.5 * centring * distances.array().square().matrix() * centring;
  const auto eigen = symmetric_eigen(gram);
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(dimension, n);
  for (Index axis = 0; axis < std::min<Index>(dimension, n); ++axis)
    points.row(axis) =
        std::sqrt(std::max(0.0, eigen.values[n - 1 - axis])) * eigen.vectors.col(n - 1 - axis).transpose();
  return points;
}

double chi_squared_of(const Eigen::MatrixXd& points, const std::vector<AnchorDistance>& distances,
                      const std::vector<bool>& used) {
  const auto residuals = distance_residuals_m(points, distances);
  double sum = 0;
  for (std::size_t k = 0; k < distances.size(); ++k)
    if (used[k]) sum += std::pow(residuals[k] / distances[k].sigma_m, 2);
  return sum;
}

/// Right-hand side -J^T W r over the points' coordinates.
Eigen::VectorXd descent(const Eigen::MatrixXd& points, const std::vector<AnchorDistance>& distances,
                        const std::vector<bool>& used) {
  const Index d = points.rows();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(points.size());
  const auto residuals = distance_residuals_m(points, distances);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (!used[k]) continue;
    const auto& [i, j, distance_m, sigma_m] = distances[k];
    const Eigen::VectorXd pull = direction_between(points, i, j) * residuals[k] / (sigma_m * sigma_m);
    gradient.segment(static_cast<Index>(i) * d, d) -= pull;
    gradient.segment(static_cast<Index>(j) * d, d) += pull;
  }
  return gradient;
}

/// Refines the points by Levenberg-Marquardt; returns chi-squared.
double refine(Eigen::MatrixXd& points, const std::vector<AnchorDistance>& distances,
              const std::vector<bool>& used) {
  double cost = chi_squared_of(points, distances, used), damping = kFirstDamping;
  for (int step = 0; step < kMaxDampedSteps && damping < kMaxDamping; ++step) {
    Eigen::MatrixXd information = distance_information(points, distances, used);
    information.diagonal().array() += damping * information.diagonal().mean();
    const Eigen::VectorXd move = ldlt_solve(information, descent(points, distances, used));
    const Eigen::MatrixXd moved = points + move.reshaped(points.rows(), points.cols());
    const double moved_cost = chi_squared_of(moved, distances, used);
    if (!(moved_cost < cost)) {
      damping *= 10;
      continue;
    }
    const bool settled = cost - moved_cost < kSettled * cost;
    points = moved, cost = moved_cost;
    damping = std::max(kMinDamping, damping / 10);
    if (settled) break;
  }
  return cost;
}

}  // namespace

double DistanceFit::noise_factor() const {
  return redundancy > 0 ? std::sqrt(chi_squared / static_cast<double>(redundancy)) : 1;
}

std::vector<bool> connected_to_first(std::size_t points, const std::vector<AnchorDistance>& distances) {
  std::vector<bool> connected(points);
  if (points > 0) connected[0] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (const auto& distance : distances) {
      if (connected[distance.i] == connected[distance.j]) continue;
      connected[distance.i] = connected[distance.j] = grown = true;
    }
  }
  return connected;
}

DistanceFit fit_distances(std::size_t points, int dimension, const std::vector<AnchorDistance>& distances,
                          const std::vector<bool>& used) {
  DistanceFit fit;
  fit.points = classical_scaling(completed(points, distances, used), dimension);
  fit.chi_squared = refine(fit.points, distances, used);
  const auto freedom = static_cast<std::ptrdiff_t>(points) * dimension - dimension * (dimension + 1) / 2;
  fit.redundancy = std::count(used.begin(), used.end(), true) - freedom;
  return fit;
}

std::vector<double> distance_residuals_m(const Eigen::MatrixXd& points,
                                         const std::vector<AnchorDistance>& distances) {
  std::vector<double> residuals;
  for (const auto& [i, j, distance_m, sigma_m] : distances)
    residuals.push_back((points.col(static_cast<Index>(i)) - points.col(static_cast<Index>(j))).norm() -
                        distance_m);
  return residuals;
}

Eigen::VectorXd direction_between(const Eigen::MatrixXd& points, std::size_t i, std::size_t j) {
  const Eigen::VectorXd difference = points.col(static_cast<Index>(i)) - points.col(static_cast<Index>(j));
  const double distance = difference.norm();
  return distance > 0 ? Eigen::VectorXd(difference / distance) : Eigen::VectorXd::Zero(points.rows());
}

Eigen::MatrixXd distance_information(const Eigen::MatrixXd& points,
                                     const std::vector<AnchorDistance>& distances,
                                     const std::vector<bool>& used) {
  const Index d = points.rows();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(points.size(), points.size());
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (!used[k]) continue;
    const Index i = static_cast<Index>(distances[k].i) * d, j = static_cast<Index>(distances[k].j) * d;
    const Eigen::VectorXd u =
        direction_between(points, distances[k].i, distances[k].j) / distances[k].sigma_m;
    const Eigen::MatrixXd block = u * u.transpose();
    information.block(i, i, d, d) += block, information.block(j, j, d, d) += block;
    information.block(i, j, d, d) -= block, information.block(j, i, d, d) -= block;
  }
  return information;
}

}  // namespace radioslam
