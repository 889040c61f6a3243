#include "radioslam/sim/sensors/wheel_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

ConstantErrors draw_constant_errors(const WheelOdometryParams& params, Rng rng) {
  ConstantErrors errors;
  errors.yaw_drift_per_m_rad = rng.normal(0, params.sigma_yaw_drift_per_m_rad);
  errors.scale = rng.normal(0, params.sigma_scale);
  return errors;
}

SE2 measure_increment(const SE2& increment, const WheelOdometryParams& params, const ConstantErrors& errors,
                      Rng& rng) {
  SE2::Tangent xi = increment.log();
  const double path_m = xi.head<2>().norm();
  const double root_path = std::sqrt(path_m);
  xi.x() += errors.scale * xi.x() + rng.normal(0, params.sigma_xy_per_sqrt_m * root_path);
  xi.y() += errors.scale * xi.y() + rng.normal(0, params.sigma_xy_per_sqrt_m * root_path);
  const double sigma_yaw = std::hypot(params.sigma_yaw_per_sqrt_m_rad * root_path,
                                      params.sigma_yaw_per_rad * std::sqrt(std::abs(xi.z())));
  xi.z() += errors.yaw_drift_per_m_rad * path_m + rng.normal(0, sigma_yaw);
  return SE2::exp(xi);
}

DriftedDrive draw_once(const std::vector<SE2>& T_floor_body, const WheelOdometryParams& params,
                       const Rng& rng) {
  DriftedDrive result;
  result.errors = draw_constant_errors(params, rng.split("constant"));
  Rng white = rng.split("white");
  result.T_start_body.reserve(T_floor_body.size());
  result.T_start_body.emplace_back();
  for (std::size_t i = 1; i < T_floor_body.size(); ++i) {
    const SE2 increment = T_floor_body[i - 1].inverse() * T_floor_body[i];
    result.T_start_body.push_back(result.T_start_body.back() *
                                  measure_increment(increment, params, result.errors, white));
  }
  const SE2 T_start_end = T_floor_body.front().inverse() * T_floor_body.back();
  result.end_error_m = (result.T_start_body.back().translation() - T_start_end.translation()).norm();
  return result;
}

/// Distance of an end error from the wanted interval; 0 inside.
double miss_m(double end_error_m, const WheelOdometryParams& params) {
  return std::max({0.0, params.end_error_min_m - end_error_m, end_error_m - params.end_error_max_m});
}

}  // namespace

DriftedDrive draw_dead_reckoning(const std::vector<SE2>& T_floor_body, const WheelOdometryParams& params,
                                 Rng rng) {
  RADIOSLAM_CHECK(!T_floor_body.empty() && params.draws > 0, "odometry needs at least one pose and one draw");
  DriftedDrive best = draw_once(T_floor_body, params, rng.split(std::uint64_t{0}));
  for (int draw = 1; draw < params.draws && miss_m(best.end_error_m, params) > 0; ++draw) {
    DriftedDrive next = draw_once(T_floor_body, params, rng.split(static_cast<std::uint64_t>(draw)));
    if (miss_m(next.end_error_m, params) < miss_m(best.end_error_m, params)) best = std::move(next);
  }
  return best;
}

OdometryNoise stated_noise(const WheelOdometryParams& params) {
  const double factor = params.stated_noise_factor;
  OdometryNoise noise;
  noise.sigma_xy_per_sqrt_m = factor * params.sigma_xy_per_sqrt_m;
  noise.sigma_yaw_per_sqrt_m_rad = factor * params.sigma_yaw_per_sqrt_m_rad;
  noise.sigma_yaw_per_rad = factor * params.sigma_yaw_per_rad;
  noise.sigma_yaw_drift_per_m_rad = factor * params.sigma_yaw_drift_per_m_rad;
  noise.sigma_scale = factor * params.sigma_scale;
  return noise;
}

}  // namespace radioslam
