// Adaptive thresholds of LiDAR odometry, as in KISS-ICP (Vizzo et al. 2023, "adaptive threshold").
//
//   sigma    root of the running mean square of the prediction's error, per axis
//   nominal  running mean of the inlier ratio
//
// Both are unknown, and have wide values of their own, before the second scan of a map is registered.
#pragma once

#include <cstddef>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/lidar/registration.hpp"

namespace radioslam {

class PredictionError {
 public:
  explicit PredictionError(const LidarOdometryParams& params) : params_(params) {}

  bool is_known() const { return count_ > 0; }

  /// Standard deviation of a predicted pose.
  double sigma_m() const;
  double sigma_rad() const;
  /// By how much a point at this range may be off.
  double sigma_at_range_m(double range_m) const { return sigma_m() + sigma_rad() * range_m; }
  /// The predicted pose as a prior, `prior_factor` times as uncertain.
  PosePrior prior_at(const SE3& predicted) const;

  double nominal_inlier_ratio() const { return nominal_inlier_ratio_; }
  /// Smallest inlier ratio of a registered scan.
  double min_inlier_ratio() const;
  /// The inlier ratio below which a scan is relocalised.
  double relocalise_below_ratio() const;

  /// Adds the error of a registered scan's prediction, and its inlier ratio.
  void update(const SE3& error, double inlier_ratio);

  /// The next map starts without a known error.
  void forget();

 private:
  LidarOdometryParams params_;
  double squares_m2_ = 0, squares_rad2_ = 0;  ///< means per axis
  std::size_t count_ = 0;
  double nominal_inlier_ratio_ = 0;
};

}  // namespace radioslam
