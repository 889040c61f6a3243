// Points of the plane from their mutual distances (classical multidimensional scaling, Torgerson 1952).
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// 2 x n coordinates whose distances approximate the symmetric n x n `distances_m`, centred at the origin.
/// Rotation and handedness are arbitrary but the same on every run.
Eigen::Matrix2Xd classical_scaling(const Eigen::MatrixXd& distances_m);

}  // namespace radioslam
