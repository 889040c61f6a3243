// Fields of view of two sensors in the horizontal plane: their distance, and the share of them that is
// common. A view is the sector of the horizontal plane within `range_m` of the body and within half the field
// of view of its heading (body x seen from above); it is not limited vertically.
//
// Two views can overlap, by definition, if
//   distance(sector of k, sector of l widened by D sigma_yaw on both sides) <= D sigma,
// with sigma^2 the largest eigenvalue of the horizontal covariance of l's position, sigma_yaw the standard
// deviation of its heading, both seen from k, and D the Mahalanobis bound. Every displacement and rotation of
// l within D standard deviations for which the sectors overlap satisfies it, so the test rejects none of
// them.
//
// Shared view: intersection over union of two views, |A n B| / (|A| + |B| - |A n B|). It grows with the
// common area, so an upper bound of that area is one of the share. With l anywhere within D standard
// deviations,
//   |A n B| <= min(|A|, |B|, |A n (B widened by D sigma_yaw on both sides, dilated by D sigma)|).
// Two views whose bodies are d apart have at most the common area of two discs at d, whatever their headings;
// hence the distance beyond which they share less than a given part. For discs it is exact.
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <optional>

namespace radioslam {

/// Range of a robot's sensor and its horizontal field of view about body x.
struct OverlapSensor {
  double range_m = 30;
  double view_rad = 2 * std::numbers::pi;
};

/// Sector of a disc in the horizontal plane; a full disc for half angles of pi or more.
struct ViewSector {
  Eigen::Vector2d apex_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double half_angle_rad = 0;
  double range_m = 0;
};

/// Distance (m) between the nearest points of two sectors; 0 if they overlap.
double sector_distance(const ViewSector& a, const ViewSector& b);

/// Intersection over union of two views, 0 to 1; 0 if either has no area. Exact for two discs, else by a sum
/// over rays from a's apex, within 1e-3.
double shared_view(const ViewSector& a, const ViewSector& b);

/// Upper bound of the shared view if b is displaced by at most `offset_m` and turned by at most `turn_rad`;
/// the shared view itself if both are 0.
double max_shared_view(const ViewSector& a, const ViewSector& b, double offset_m, double turn_rad);
/// Whether that is at least `min_shared_view`: by fewer rays where they decide.
bool can_share_view(const ViewSector& a, const ViewSector& b, double offset_m, double turn_rad,
                    double min_shared_view);

/// Largest distance at which two discs share at least this much; the sum of the ranges for 0, nothing if even
/// concentric discs share less.
std::optional<double> max_distance_of_shared_view(double range_a_m, double range_b_m, double min_shared_view);

/// Distance beyond which two sensors share less, whatever their headings.
std::optional<double> max_distance_of_shared_view(const OverlapSensor& a, const OverlapSensor& b,
                                                  double min_shared_view);

}  // namespace radioslam
