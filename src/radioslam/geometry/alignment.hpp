// The rigid motion that best carries one set of points onto another (Umeyama 1991, without scale).
#pragma once

#include <Eigen/Core>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// T_target_source that minimises the sum of w_i |target_i - T source_i|^2, never a reflection.
/// Shapes: 2 x n (3 x n), weights n or empty for equal ones. n >= 1; what the points leave open (a
/// rotation about a single point or a line) is resolved to some proper rotation.
SE2 align_points(const Eigen::Matrix2Xd& source, const Eigen::Matrix2Xd& target,
                 const Eigen::VectorXd& weights = {});
SE3 align_points(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target,
                 const Eigen::VectorXd& weights = {});

}  // namespace radioslam
