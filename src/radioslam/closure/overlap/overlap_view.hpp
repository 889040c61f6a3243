// Distance between the fields of view of two sensors with a limited horizontal field of view.
// A view is the sector of the horizontal plane within `range_m` of the body and within half the field of view
// of its heading (body x seen from above); it is not limited vertically.
//
// Two views can overlap, by definition, if
//   distance(sector of k, sector of l widened by D sigma_yaw on both sides) <= D sigma,
// with sigma^2 the largest eigenvalue of the horizontal covariance of l's position, sigma_yaw the standard
// deviation of its heading, both seen from k, and D the Mahalanobis bound. Every displacement and rotation of
// l within D standard deviations for which the sectors overlap satisfies it, so the test rejects none of
// them.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// Sector of a disc in the horizontal plane; a full disc for half angles of pi or more.
struct ViewSector {
  Eigen::Vector2d apex_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double half_angle_rad = 0;
  double range_m = 0;
};

/// Distance (m) between the nearest points of two sectors; 0 if they overlap.
double sector_distance(const ViewSector& a, const ViewSector& b);

}  // namespace radioslam
