#include "radioslam/rendezvous/angle_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kSmallestDistance_m = 0.05;  ///< closer robots have no direction to speak of
constexpr double kPi = std::numbers::pi;

double density(double error, double sigma) {
  return std::exp(-0.5 * error * error / (sigma * sigma)) / (sigma * std::sqrt(2 * kPi));
}

}  // namespace

AngleEvidence check_angles(const PredictedPose& pose, const std::vector<std::vector<ArrivalPath>>& packets,
                           const AngleCheckParams& params) {
  const auto& position = pose.T_i_j.translation();
  const double distance_m = position.norm();
  if (distance_m < kSmallestDistance_m) return {};
  const double predicted = std::atan2(position.y(), position.x());
  const double across = pose.sigma_m / distance_m;
  const double variance = across * across + pose.sigma_rad * pose.sigma_rad;
  AngleEvidence evidence;
  double log_odds = 0;
  int used = 0;
  for (const auto& paths : packets) {
    if (paths.empty()) continue;
    double likelihood = 0, amplitudes = 0, nearest = kPi, nearest_sigma = 1;
    for (const ArrivalPath& path : paths) {
      const double amplitude = std::pow(10.0, path.power_db / 20);
      const double error = wrap_angle(predicted - path.azimuth_rad);
      amplitudes += amplitude;
      likelihood += amplitude * density(error, std::sqrt(path.sigma_rad * path.sigma_rad + variance));
      if (std::abs(error) < std::abs(nearest)) {
        nearest = error;
        nearest_sigma = path.sigma_rad;
      }
    }
    if (!(amplitudes > 0)) continue;
    log_odds -= std::log(1 - params.direct_ratio + 2 * kPi * params.direct_ratio * likelihood / amplitudes);
    ++used;
    const double scaled = nearest / nearest_sigma;
    evidence.scale = std::abs(nearest) < params.threshold_rad ? 1 : std::exp(-0.5 * scaled * scaled);
  }
  if (used > 0) evidence.log_odds = log_odds / used;
  return evidence;
}

}  // namespace radioslam
