#include "radioslam/radio/aoa/aoa_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/direction.hpp"

namespace radioslam {
namespace {

constexpr double kNoDistance_m = 1e-9;

struct Direction {
  double azimuth_rad = 0, elevation_rad = 0;
};

struct AngleErrors {
  double azimuth_rad = 0;
  std::optional<double> elevation_rad;

  double sum_rad() const { return std::abs(azimuth_rad) + std::abs(elevation_rad.value_or(0)); }
};

AngleErrors errors_against(const AoaPath& path, const Direction& predicted) {
  AngleErrors errors{wrap_angle(predicted.azimuth_rad - path.azimuth_rad), std::nullopt};
  if (path.elevation_rad) errors.elevation_rad = predicted.elevation_rad - *path.elevation_rad;
  return errors;
}

}  // namespace

double angle_weight(double error_rad, double sigma_rad, AngleWeight form) {
  RADIOSLAM_CHECK(sigma_rad > 0, "the sigma of an angle is positive");
  const double in_sigmas = error_rad / sigma_rad;
  const double gaussian = std::exp(-in_sigmas * in_sigmas / 2);
  return form == AngleWeight::kGaussian ? gaussian : std::min(1.0, gaussian / sigma_rad);
}

AoaAgreement check_relative_pose(const SE3& T_i_j, const AoaMeasurement& measured,
                                 const AoaLikelihoodParams& params, const DirectionSigma& predicted) {
  RADIOSLAM_CHECK(!measured.paths.empty(), "an AoA measurement has at least one path");
  const Eigen::Vector3d antenna = T_i_j * measured.transmitter.lever_arm_m;
  const double distance_m = antenna.norm();
  if (distance_m < kNoDistance_m) return {};
  const double level_m = std::max(antenna.head<2>().norm(), kNoDistance_m);
  const Direction direction{std::atan2(antenna.y(), antenna.x()), std::atan2(antenna.z(), level_m)};

  AoaAgreement check;
  AngleErrors nearest{std::numeric_limits<double>::infinity(), std::nullopt};
  for (std::size_t p = 0; p < measured.paths.size(); ++p) {
    const AngleErrors errors = errors_against(measured.paths[p], direction);
    if (!(errors.sum_rad() < nearest.sum_rad())) continue;
    nearest = errors;
    check.nearest_path = p;
  }
  const double sigma_rad = measured.paths[check.nearest_path].sigma_rad;
  const AngleWeight form = angle_weight_form(params);
  const auto beyond = [&](double error_rad) { return std::abs(error_rad) >= params.threshold_rad; };

  check.azimuth_error_rad = nearest.azimuth_rad;
  check.azimuth_sigma_rad = std::hypot(sigma_rad * distance_m / level_m,
                                       params.sigma_antenna_position_m / level_m, predicted.azimuth_rad);
  check.weight = angle_weight(check.azimuth_error_rad, check.azimuth_sigma_rad, form);
  bool is_beyond = beyond(check.azimuth_error_rad);
  if (nearest.elevation_rad) {
    check.elevation_error_rad = nearest.elevation_rad;
    check.elevation_sigma_rad =
        std::hypot(sigma_rad, params.sigma_antenna_position_m / distance_m, predicted.elevation_rad);
    check.weight *= angle_weight(*nearest.elevation_rad, check.elevation_sigma_rad, form);
    is_beyond = is_beyond || beyond(*nearest.elevation_rad);
  }
  check.status = is_beyond ? AngleStatus::kBeyond : AngleStatus::kAgrees;
  return check;
}

double log_odds_elsewhere(const SE3& T_i_j, const AoaMeasurement& measured, double direct_probability,
                          double band_rad, const AoaLikelihoodParams& params) {
  const Eigen::Vector3d antenna = T_i_j * measured.transmitter.lever_arm_m;
  const double level_m = antenna.head<2>().norm();
  if (level_m < kNoDistance_m) return 0;
  const double azimuth_rad = std::atan2(antenna.y(), antenna.x());
  double hit = 0;
  for (const AoaPath& path : measured.paths) {
    const double sigma_rad =
        std::hypot(path.sigma_rad * antenna.norm() / level_m, params.sigma_antenna_position_m / level_m);
    const double off_rad =
        std::max(0.0, std::abs(wrap_angle(azimuth_rad - path.azimuth_rad)) - band_rad) / sigma_rad;
    const double all_around = std::erf(std::numbers::pi / sigma_rad / std::numbers::sqrt2);
    hit += std::exp(-off_rad * off_rad / 2) * std::sqrt(2 * std::numbers::pi) / sigma_rad / all_around;
  }
  return -std::log(1 - direct_probability +
                   direct_probability * hit / static_cast<double>(measured.paths.size()));
}

Eigen::Vector3d unit_vector(const AoaPath& path) {
  return unit_direction(path.azimuth_rad, path.elevation_rad.value_or(0));
}

AoaMeasurement levelled(AoaMeasurement measured, const SE3& T_start_receiver) {
  const Eigen::AngleAxisd without_yaw(-T_start_receiver.yaw(), Eigen::Vector3d::UnitZ());
  for (AoaPath& path : measured.paths) {
    const Eigen::Vector3d level = without_yaw * (T_start_receiver.rotation() * unit_vector(path));
    path.azimuth_rad = std::atan2(level.y(), level.x());
    path.elevation_rad.reset();
  }
  return measured;
}

}  // namespace radioslam
