// Points from some of their mutual distances: classical scaling (Torgerson 1952) of the matrix that shortest
// paths complete (Shang et al. 2003), then least squares on the measured distances (Wi-Closure 4.3.2):
//   minimise the sum over measured (i, j) of ((|p_i - p_j| - A_ij) / sigma_ij)^2.
// Rotation, shift and handedness are left open. Metres. Cost: O(n^3) per step for n points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace radioslam {

/// |p_i - p_j| as measured.
struct AnchorDistance {
  std::size_t i = 0, j = 0;
  double distance_m = 0;
  double sigma_m = 0.01;
};

/// Whose distances, taken together, tie each point to the first one. Per point.
std::vector<bool> tied_to_first(std::size_t points, const std::vector<AnchorDistance>& distances);

/// How points fit the distances used.
struct DistanceFit {
  Eigen::MatrixXd points;         ///< dimension x n
  double chi_squared = 0;         ///< sum of squared residuals over sigmas
  std::ptrdiff_t redundancy = 0;  ///< distances less the shape's degrees of freedom; negative: not enough

  /// Root of chi-squared over redundancy; 1 without any.
  double noise_factor() const;
};

/// The best points of this dimension for the distances with `used`. The points must be tied together.
DistanceFit fit_distances(std::size_t points, int dimension, const std::vector<AnchorDistance>& distances,
                          const std::vector<bool>& used);

/// (|p_i - p_j| - A_ij) of every distance.
std::vector<double> distance_residuals_m(const Eigen::MatrixXd& points,
                                         const std::vector<AnchorDistance>& distances);

/// J^T W J of the points' coordinates, point by point, over the distances used; W = 1 / sigma^2.
Eigen::MatrixXd distance_information(const Eigen::MatrixXd& points,
                                     const std::vector<AnchorDistance>& distances,
                                     const std::vector<bool>& used);

/// Derivative of distance (i, j) by the coordinates of point i; that of j is its opposite. Zero where the
/// points coincide.
Eigen::VectorXd direction_between(const Eigen::MatrixXd& points, std::size_t i, std::size_t j);

}  // namespace radioslam
