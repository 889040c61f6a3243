#include "radioslam/mission/dead_reckoning.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "radioslam/base/check.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kGravity_mps2 = 9.80665;  // standard gravity

using Readings = std::vector<VectorSample>;

/// Sample at a stamp, linearly interpolated and clamped at both ends.
Eigen::Vector3d reading_at(const Readings& readings, Stamp stamp) {
  const auto after = std::lower_bound(readings.begin(), readings.end(), stamp,
                                      [](const VectorSample& r, Stamp s) { return r.stamp < s; });
  if (after == readings.begin()) return after->value;
  const auto before = after - 1;
  if (after == readings.end()) return before->value;
  const double fraction =
      seconds_between(before->stamp, stamp) / seconds_between(before->stamp, after->stamp);
  return before->value + fraction * (after->value - before->value);
}

/// Device tilt from the mean of the first samples.
Eigen::Quaterniond tilt_at_start(const Readings& specific_force, double duration_s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& reading : specific_force) {
    if (seconds_between(specific_force.front().stamp, reading.stamp) > duration_s) break;
    sum += reading.value;
  }
  return rotation_between(sum, Eigen::Vector3d::UnitZ());
}

/// Rotates the level frame so that the measured up moves towards z by the given fraction.
Eigen::Quaterniond lean_towards_up(const Eigen::Quaterniond& R, const Eigen::Vector3d& force,
                                   double fraction) {
  const Eigen::Vector3d up = (R * force).normalized();
  return so3_exp(std::min(fraction, 1.0) * up.cross(Eigen::Vector3d::UnitZ())) * R;
}

double heading_of(const Eigen::Quaterniond& R) {
  const Eigen::Vector3d forward = R * Eigen::Vector3d::UnitY();
  return std::atan2(forward.y(), forward.x());
}

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

using Signal = std::vector<double>;

constexpr double kGaussianReach = 3;  // sigmas beyond which weights are negligible

/// Gaussian average around every sample, normalised over the available samples.
Signal averaged(const std::vector<LevelSample>& motion, const Signal& signal, double sigma_s) {
  Signal result(signal.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    while (seconds_between(motion[begin].stamp, motion[i].stamp) > kGaussianReach * sigma_s) ++begin;
    double sum = 0, weights = 0;
    for (std::size_t k = begin; k < signal.size(); ++k) {
      const double z = seconds_between(motion[i].stamp, motion[k].stamp) / sigma_s;
      if (z > kGaussianReach) break;
      const double weight = std::exp(-0.5 * z * z);
      sum += weight * signal[k];
      weights += weight;
    }
    result[i] = sum / weights;
  }
  return result;
}

Signal band_passed(const std::vector<LevelSample>& motion, const StepParams& params) {
  Signal vertical;
  for (const auto& sample : motion) vertical.push_back(sample.vertical_mps2);
  Signal signal = averaged(motion, vertical, params.smooth_s);
  const Signal slow = averaged(motion, vertical, params.detrend_s);
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] -= slow[i];
  return signal;
}

Signal local_rms(const std::vector<LevelSample>& motion, const Signal& signal, double window_s) {
  Signal squares;
  for (const double value : signal) squares.push_back(value * value);
  Signal rms = averaged(motion, squares, window_s);
  for (double& value : rms) value = std::sqrt(value);
  return rms;
}

/// Indices of peaks that are high enough and the highest within `min_step_s`.
std::vector<std::size_t> find_peaks(const std::vector<LevelSample>& motion, const Signal& signal,
                                    const StepParams& params) {
  const Signal rms = local_rms(motion, signal, params.rms_window_s);
  std::vector<std::size_t> peaks;
  for (std::size_t i = 1; i + 1 < signal.size(); ++i) {
    if (signal[i] <= signal[i - 1] || signal[i] < signal[i + 1]) continue;
    if (signal[i] < std::max(params.peak_floor_mps2, params.peak_rms_ratio * rms[i])) continue;
    const bool follows_closely =
        !peaks.empty() && seconds_between(motion[peaks.back()].stamp, motion[i].stamp) < params.min_step_s;
    if (!follows_closely)
      peaks.push_back(i);
    else if (signal[i] > signal[peaks.back()])
      peaks.back() = i;
  }
  return peaks;
}

Stamp before(Stamp stamp, double seconds) { return {stamp.ns - Stamp::from_seconds(seconds).ns}; }

/// max - min of the signal from the stamp `begin` to the sample `last`.
double swing(const std::vector<LevelSample>& motion, const Signal& signal, Stamp begin, std::size_t last) {
  double low = signal[last], high = signal[last];
  for (std::size_t i = last; i > 0 && begin <= motion[i - 1].stamp; --i) {
    low = std::min(low, signal[i - 1]);
    high = std::max(high, signal[i - 1]);
  }
  return high - low;
}

/// Heading over time, from the frame's x axis.
class Headings {
 public:
  Headings(const std::vector<LevelSample>& motion, const std::optional<CompassFit>& compass)
      : motion_(motion) {
    for (const auto& sample : motion)
      heading_.push_back(sample.heading_rad + (compass ? compass->correction_rad(sample.stamp) : 0));
  }

  /// Heading of the last sample at or before `stamp`; 0 without samples.
  double at(Stamp stamp) const {
    if (heading_.empty()) return 0;
    const std::size_t after = first_after(stamp);
    return heading_[after == 0 ? 0 : after - 1];
  }

  /// Circular mean of the headings between the stamps.
  double mean(Stamp begin, Stamp end) const {
    double c = std::cos(at(begin)), s = std::sin(at(begin));
    for (std::size_t i = first_after(begin); i < first_after(end); ++i) {
      c += std::cos(heading_[i]);
      s += std::sin(heading_[i]);
    }
    return std::atan2(s, c);
  }

 private:
  std::size_t first_after(Stamp stamp) const {
    const auto after = std::upper_bound(motion_.begin(), motion_.end(), stamp,
                                        [](Stamp s, const LevelSample& m) { return s < m.stamp; });
    return static_cast<std::size_t>(after - motion_.begin());
  }

  const std::vector<LevelSample>& motion_;
  std::vector<double> heading_;
};

/// Trajectory with poses at the beginning, at both ends of every step and at the end.
Trajectory<SE3> walk_along(const std::vector<Step>& steps, const Headings& headings, Stamp begin, Stamp end) {
  std::vector<StampedPose<SE3>> poses{{begin, lift(SE2({0, 0}, headings.at(begin)))}};
  Eigen::Vector2d position(0, 0);
  const auto append_pose = [&](Stamp stamp) {
    if (poses.back().stamp < stamp) poses.push_back({stamp, lift(SE2(position, headings.at(stamp)))});
  };
  for (const Step& step : steps) {
    if (step.begin < begin || end < step.end) continue;
    append_pose(step.begin);
    const double heading = headings.mean(step.begin, step.end);
    position += step.length_m * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    append_pose(step.end);
  }
  append_pose(end);
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace

std::vector<LevelSample> level_motion(const PhoneMotion& motion, const LevellingParams& params) {
  const auto& rates = motion.angular_rate_radps;
  if (rates.empty() || motion.specific_force_mps2.empty()) return {};
  Eigen::Quaterniond R = tilt_at_start(motion.specific_force_mps2, params.gravity_start_s);
  double heading = 0, last = heading_of(R);
  std::vector<LevelSample> samples;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Eigen::Vector3d force = reading_at(motion.specific_force_mps2, rates[i].stamp);
    if (i > 0) {
      const double dt = seconds_between(rates[i - 1].stamp, rates[i].stamp);
      R = R * so3_exp(0.5 * dt * (rates[i - 1].value + rates[i].value));
      R = lean_towards_up(R, force, dt / params.gravity_time_s).normalized();
      const double now = heading_of(R);
      heading += wrap_angle(now - last);
      last = now;
    }
    samples.push_back({rates[i].stamp, heading, (R * force).z() - kGravity_mps2});
  }
  return samples;
}

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

std::vector<Step> find_steps(const std::vector<LevelSample>& motion, const StepParams& params) {
  const Signal signal = band_passed(motion, params);
  std::vector<Step> steps;
  for (const std::size_t peak : find_peaks(motion, signal, params)) {
    Step step;
    step.end = motion[peak].stamp;
    const bool walking = !steps.empty() && seconds_between(steps.back().end, step.end) <= params.max_step_s;
    const Stamp earliest = steps.empty() ? motion.front().stamp : steps.back().end;
    step.begin = walking ? earliest : std::max(earliest, before(step.end, params.nominal_step_s));
    step.length_m = params.weinberg_k * std::pow(swing(motion, signal, step.begin, peak), 0.25);
    steps.push_back(step);
  }
  return steps;
}

DeadReckoning dead_reckon(const PhoneMotion& motion, Stamp begin, Stamp end,
                          const DeadReckoningParams& params) {
  RADIOSLAM_CHECK(begin < end, "begin must precede end");
  const auto level = level_motion(motion, params.levelling);
  DeadReckoning walk;
  walk.steps = find_steps(level, params.steps);
  walk.compass = fit_compass(level, motion.orientation, params.compass);
  walk.odometry = walk_along(walk.steps, Headings(level, walk.compass), begin, end);
  return walk;
}

OdometryNoise walking_noise() {
  OdometryNoise noise;
  noise.sigma_xy_per_sqrt_m = 0.2;
  noise.sigma_yaw_per_sqrt_m_rad = 0.02;  // the phone sways in the hand
  noise.sigma_yaw_per_rad = 0.05;         // and turns a little later or less than the surveyor
  noise.sigma_yaw_drift_per_m_rad = 0.004;
  noise.sigma_scale = 0.1;
  return noise;
}

}  // namespace radioslam
