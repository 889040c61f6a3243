// Classical multidimensional scaling: points of the plane from their mutual distances (Torgerson 1952).
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// 2 x n coordinates whose distances approximate the symmetric n x n `distances_m`, centred at the origin.
/// Rotation and handedness are arbitrary but deterministic.
Eigen::Matrix2Xd classical_scaling(const Eigen::MatrixXd& distances_m);

}  // namespace radioslam
