// Correspondences of a scan's surfels at one pose, and the sums of their Gauss-Newton normal equations.
//
//   e_k = q_k - T p_k                q_k: the target's surfel nearest to T p_k, within max_distance_m
//   W_k = (C_q + R C_p R' + b^2 I)^-1, with the variance of the normals times the squared distance in C
//   H = sum w J' W J,  g = sum w J' W e,  w = rho_c'    c: loss_scale, Geman, McClure;  b: kernel_width_m
//
// Both are found in one pass over the points, block by block: the sums do not depend on the number of
// threads.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

/// The target's nearest surfel closer than the root of the second argument, or null; thread-safe.
using NearestSurfel = std::function<const Surfel*(const Eigen::Vector3f& point, float squared_max_distance)>;

struct CorrespondenceSearch {
  double max_distance_m = 1;
  double point_distance_ratio = 1;  ///< max. distance of points without a normal, over that of others
  double kernel_width_m = 0;
  double loss_scale = 3;
};

struct LinearisedPoints {
  SE3::Jacobian hessian = SE3::Jacobian::Zero();
  SE3::Tangent gradient = SE3::Tangent::Zero();
  double normal_noise_information = 0;  ///< sum of w tr(W) s^2, s^2: variance of noisy normals
  double weights = 0, weighted_squares = 0;
  std::size_t matches = 0;  ///< points with a correspondence

  void operator+=(const LinearisedPoints& other);
};

/// About xi in T Exp(xi).
LinearisedPoints linearise_correspondences(const NearestSurfel& target, const std::vector<Surfel>& source,
                                           const SE3& T, const CorrespondenceSearch& search);

}  // namespace radioslam
