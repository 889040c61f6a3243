#include "radioslam/mission/levelling.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace radioslam
