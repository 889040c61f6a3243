// What position fixes say of a heading.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// Information on the heading of a rigid body by fixes of points on it, 1/rad^2. `places_m`: 2 x n;
/// `weights`: 1/m^2, their sum positive.
inline double heading_information(const Eigen::Matrix2Xd& places_m, const Eigen::VectorXd& weights) {
  const Eigen::Vector2d middle = places_m * weights / weights.sum();
  return weights.dot((places_m.colwise() - middle).colwise().squaredNorm().transpose());
}

}  // namespace radioslam
