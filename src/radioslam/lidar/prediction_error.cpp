#include "radioslam/lidar/prediction_error.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {

double PredictionError::sigma_m() const {
  return is_known() ? std::max(params_.min_sigma_m, std::sqrt(squares_m2_)) : params_.first_sigma_m;
}

double PredictionError::sigma_rad() const {
  return is_known() ? std::max(params_.min_sigma_rad, std::sqrt(squares_rad2_)) : params_.first_sigma_rad;
}

PosePrior PredictionError::prior_at(const SE3& predicted) const {
  const double wide_m = params_.prior_factor * sigma_m(), wide_rad = params_.prior_factor * sigma_rad();
  return {predicted, isotropic(1 / (wide_m * wide_m), 1 / (wide_rad * wide_rad))};
}

double PredictionError::min_inlier_ratio() const {
  return is_known() ? std::max(params_.min_inlier_ratio, params_.min_nominal_ratio * nominal_inlier_ratio_)
                    : params_.min_first_inlier_ratio;
}

double PredictionError::relocalise_below_ratio() const {
  return is_known() ? std::max(min_inlier_ratio(), params_.relocalise_below_ratio * nominal_inlier_ratio_)
                    : 1;
}

void PredictionError::update(const SE3& error, double inlier_ratio) {
  const double newest = std::max(1 / static_cast<double>(++count_), params_.error_smoothing);
  const auto towards = [&](double& mean, double squares) { mean += newest * (squares / 3 - mean); };
  towards(squares_m2_, error.translation().squaredNorm());
  towards(squares_rad2_, error.log().tail<3>().squaredNorm());
  nominal_inlier_ratio_ += newest * (inlier_ratio - nominal_inlier_ratio_);
}

void PredictionError::forget() {
  squares_m2_ = squares_rad2_ = 0;
  count_ = 0;
}

}  // namespace radioslam
