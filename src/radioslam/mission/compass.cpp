#include "radioslam/mission/compass.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr int kIterations = 20;

/// Fused minus gyroscope heading at one stamp, wrapped.
struct Difference {
  double t_s = 0;  ///< since the middle
  double angle_rad = 0;
};

double heading_from_east(const Eigen::Quaterniond& R_enu_device) {
  const Eigen::Vector3d forward = R_enu_device * Eigen::Vector3d::UnitY();
  return std::atan2(forward.y(), forward.x());
}

/// Gyroscope heading at a stamp: that of the last sample before it.
double heading_at(const std::vector<LevelSample>& motion, Stamp stamp) {
  const auto after = std::upper_bound(motion.begin(), motion.end(), stamp,
                                      [](Stamp s, const LevelSample& m) { return s < m.stamp; });
  return after == motion.begin() ? after->heading_rad : (after - 1)->heading_rad;
}

std::vector<Difference> differences(const std::vector<LevelSample>& motion,
                                    const std::vector<OrientationSample>& orientation, Stamp middle) {
  std::vector<Difference> result;
  for (const auto& sample : orientation)
    result.push_back({seconds_between(middle, sample.stamp),
                      wrap_angle(heading_from_east(sample.R_enu_device) - heading_at(motion, sample.stamp))});
  return result;
}

/// Circular mean of the differences: initial value of the fit.
double mean_direction(const std::vector<Difference>& differences) {
  double c = 0, s = 0;
  for (const auto& d : differences) {
    c += std::cos(d.angle_rad);
    s += std::sin(d.angle_rad);
  }
  return std::atan2(s, c);
}

double residual(const Difference& d, const CompassFit& fit) {
  return wrap_angle(d.angle_rad - fit.offset_rad - fit.drift_radps * d.t_s);
}

/// One weighted least-squares step for offset and drift. `information` is that of one sample.
CompassFit improved(const std::vector<Difference>& differences, CompassFit fit, double information,
                    const CompassParams& params) {
  Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  const double prior = 1 / (params.sigma_drift_radps * params.sigma_drift_radps);
  h(1, 1) = prior;
  g[1] = -prior * fit.drift_radps;
  for (const auto& d : differences) {
    const double r = residual(d, fit);
    const double scaled = r / params.cauchy_scale_rad;
    const double weight = information / (1 + scaled * scaled);
    const Eigen::Vector2d j(1, d.t_s);
    h += weight * j * j.transpose();
    g += weight * r * j;
  }
  const Eigen::Vector2d step = inverse(h) * g;
  fit.offset_rad = wrap_angle(fit.offset_rad + step[0]);
  fit.drift_radps += step[1];
  return fit;
}

double median_magnitude(const std::vector<Difference>& differences, const CompassFit& fit) {
  std::vector<double> magnitudes;
  for (const auto& d : differences) magnitudes.push_back(std::abs(residual(d, fit)));
  return upper_median(std::move(magnitudes));
}

}  // namespace

std::optional<CompassFit> fit_compass(const std::vector<LevelSample>& motion,
                                      const std::vector<OrientationSample>& orientation,
                                      const CompassParams& params) {
  if (motion.empty() || orientation.empty()) return std::nullopt;
  const Stamp begin = orientation.front().stamp, end = orientation.back().stamp;
  CompassFit fit;
  fit.middle = Stamp{begin.ns + (end.ns - begin.ns) / 2};
  const auto samples = differences(motion, orientation, fit.middle);
  fit.offset_rad = mean_direction(samples);
  const double independent = 1 + seconds_between(begin, end) / params.independent_s;
  const double information = independent / static_cast<double>(samples.size()) /
                             (params.sigma_heading_rad * params.sigma_heading_rad);
  for (int i = 0; i < kIterations; ++i) fit = improved(samples, fit, information, params);
  fit.spread_rad = median_magnitude(samples, fit);
  return fit;
}

}  // namespace radioslam
