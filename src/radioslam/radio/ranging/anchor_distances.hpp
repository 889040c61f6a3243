// Multidimensional scaling: positions of points from an incomplete set of their mutual distances.
//
// Classical scaling (Torgerson 1952) of the distance matrix completed by shortest paths (Shang et al. 2003),
// then least squares on the measured distances (Wi-Closure 4.3.2):
//   minimise the sum over measured (i, j) of ((|p_i - p_j| - A_ij) / sigma_ij)^2.
// Rotation, translation and handedness are arbitrary. Metres. Cost: O(n^3) per step for n points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace radioslam {

/// Measured distance |p_i - p_j|.
struct AnchorDistance {
  std::size_t i = 0, j = 0;
  double distance_m = 0;
  double sigma_m = 0.01;
};

/// Per point: whether a chain of distances connects it to the first one.
std::vector<bool> connected_to_first(std::size_t points, const std::vector<AnchorDistance>& distances);

/// Points fitted to distances, and the quality of the fit.
struct DistanceFit {
  Eigen::MatrixXd points;         ///< dimension x n
  double chi_squared = 0;         ///< sum of (residual / sigma)^2
  std::ptrdiff_t redundancy = 0;  ///< distances minus degrees of freedom of the shape

  /// sqrt(chi_squared / redundancy); 1 without redundancy.
  double noise_factor() const;
};

/// Least-squares points of this dimension for the distances marked in `used`, which must connect all points.
DistanceFit fit_distances(std::size_t points, int dimension, const std::vector<AnchorDistance>& distances,
                          const std::vector<bool>& used);

/// Residual |p_i - p_j| - A_ij of every distance.
std::vector<double> distance_residuals_m(const Eigen::MatrixXd& points,
                                         const std::vector<AnchorDistance>& distances);

/// Information J^T W J over the coordinates, point by point, from the `used` distances; W = 1 / sigma^2.
Eigen::MatrixXd distance_information(const Eigen::MatrixXd& points,
                                     const std::vector<AnchorDistance>& distances,
                                     const std::vector<bool>& used);

/// Derivative of distance (i, j) over the coordinates of point i, the negative of that over j. Zero where the
/// points coincide.
Eigen::VectorXd direction_between(const Eigen::MatrixXd& points, std::size_t i, std::size_t j);

}  // namespace radioslam
