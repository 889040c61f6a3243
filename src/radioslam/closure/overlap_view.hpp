// What a sensor with a limited horizontal field of view can see, and how far two such views are apart.
// A view is the sector of the horizontal plane within `range_m` of the body and within half the field of view
// of its heading (body x seen from above). What is above or below does not limit a view.
//
// Two views can meet, by definition, when
//   distance(sector of k, sector of l widened by D sigma_yaw on both sides) <= D sigma,
// with sigma^2 the largest eigenvalue of the horizontal covariance of l's position and sigma_yaw that of its
// heading, both seen from k, and D the Mahalanobis bound. Every displacement and turn of l within D standard
// deviations that makes the sectors meet satisfies it, so the test rejects none of them.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// A sector of a disc in the horizontal plane; a whole disc from a half angle of pi on.
struct ViewSector {
  Eigen::Vector2d apex_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double half_angle_rad = 0;
  double range_m = 0;
};

/// Distance (m) between the nearest points of two sectors; 0 where they meet.
double sector_distance(const ViewSector& a, const ViewSector& b);

}  // namespace radioslam
