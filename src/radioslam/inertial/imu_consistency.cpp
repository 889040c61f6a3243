#include "radioslam/inertial/imu_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "radioslam/base/stamp_intervals.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {
namespace {

constexpr double kMaxWindow = 3;  // a window longer than this many times window_s spans a gap

std::string rounded(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

/// Rotation over a window, by the poses and by the gyroscope.
struct Turn {
  Stamp begin, end;
  Eigen::Vector3d by_poses, by_gyroscope;
  Eigen::Vector3d rates_sum;  ///< integrated rates of the gyroscope, which may exceed half a revolution

  double duration_s() const { return seconds_between(begin, end); }
};
using Turns = std::vector<Turn>;

/// Rotation from one pose to the other, assuming that IMU samples are stamped `lag_ns` late.
std::optional<Turn> turn_between(const StampedPose<SE3>& begin, const StampedPose<SE3>& end,
                                 const std::vector<ImuSample>& samples, std::int64_t lag_ns,
                                 double max_gap_s) {
  const auto intervals =
      imu_intervals(samples, {begin.stamp.ns + lag_ns}, {end.stamp.ns + lag_ns}, max_gap_s);
  if (!intervals) return std::nullopt;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuInterval& interval : *intervals) {
    const Eigen::Vector3d turn = interval.duration_s * interval.angular_rate_radps;
    rotation = rotation * so3_exp(turn);
    sum += turn;
  }
  return Turn{begin.stamp, end.stamp, so3_log(begin.pose.rotation().conjugate() * end.pose.rotation()),
              so3_log(rotation.normalized()), sum};
}

Turns turns_of(const Trajectory<SE3>& poses, const std::vector<ImuSample>& samples, double lag_s,
               const ImuNoiseParams& noise, const ImuConsistencyParams& params) {
  Turns turns;
  const std::int64_t lag_ns = Stamp::from_seconds(lag_s).ns;
  std::size_t from = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double duration_s = seconds_between(poses[from].stamp, poses[k].stamp);
    if (duration_s < params.window_s) continue;
    const std::size_t begin = std::exchange(from, k);
    if (duration_s > kMaxWindow * params.window_s) continue;
    if (const auto turn = turn_between(poses[begin], poses[k], samples, lag_ns, noise.max_gap_s))
      turns.push_back(*turn);
  }
  return turns;
}

double variance_of(const Turn& turn, const ImuConsistencyParams& params) {
  const double by_ratio = params.sigma_rotation_ratio * turn.by_poses.norm();
  return 2 * params.sigma_turn_rad * params.sigma_turn_rad + by_ratio * by_ratio;
}

/// The windows in which the body rotates, according to either sensor.
Turns real_turns(const Turns& turns, const ImuConsistencyParams& params) {
  const double min_rad = params.sigmas * params.sigma_turn_rad;
  Turns real;
  for (const Turn& turn : turns)
    if (std::max(turn.by_poses.norm(), turn.by_gyroscope.norm()) > min_rad) real.push_back(turn);
  return real;
}

Eigen::Vector3d median_bias(const Turns& turns) {
  Eigen::Vector3d bias;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> rates;
    for (const Turn& turn : turns)
      rates.push_back((turn.by_gyroscope - turn.by_poses)[axis] / turn.duration_s());
    bias[axis] = upper_median(std::move(rates));
  }
  return bias;
}

/// |r|^2 / sigma^2 of each window.
std::vector<double> misfits(const Turns& turns, const Eigen::Vector3d& bias,
                            const ImuConsistencyParams& params) {
  std::vector<double> result;
  for (const Turn& turn : turns) {
    const Eigen::Vector3d left = turn.by_gyroscope - turn.duration_s() * bias - turn.by_poses;
    result.push_back(left.squaredNorm() / variance_of(turn, params));
  }
  return result;
}

bool are_small(std::vector<double> misfits, const ImuConsistencyParams& params) {
  return upper_median(std::move(misfits)) <= 3 * params.sigmas * params.sigmas;
}

/// Ratio of the gyroscope's rotation to the poses'.
double turn_factor(const Turns& turns) {
  double both = 0, poses = 0;
  for (const Turn& turn : turns) {
    both += turn.rates_sum.dot(turn.by_poses);
    poses += turn.by_poses.squaredNorm();
  }
  return poses > 0 ? both / poses : 1;
}

bool are_scaled(const Turns& turns, double factor, const ImuConsistencyParams& params) {
  std::vector<double> misfits;
  for (const Turn& turn : turns)
    misfits.push_back((turn.rates_sum / factor - turn.by_poses).squaredNorm() / variance_of(turn, params));
  return are_small(std::move(misfits), params);
}

double max_ignored_offset_s(const Trajectory<SE3>& poses, const ImuConsistencyParams& params) {
  const double interval_s = median_interval_s(poses, &StampedPose<SE3>::stamp);
  return std::max(params.max_ignored_offset_s, params.max_ignored_offset_steps * interval_s);
}

/// Mean of the normalised squared errors, each limited to `sigmas` squared.
double mean_misfit(const Turns& all, const ImuConsistencyParams& params) {
  const Turns turns = real_turns(all, params);
  double sum = 0;
  for (const double misfit : misfits(turns, median_bias(all), params))
    sum += std::min(misfit, params.sigmas * params.sigmas);
  return sum / static_cast<double>(std::max<std::size_t>(1, turns.size()));
}

/// By how much IMU samples are stamped late, if that is significant.
std::optional<double> significant_time_offset(const Trajectory<SE3>& poses,
                                              const std::vector<ImuSample>& samples, const Turns& turns,
                                              const ImuNoiseParams& noise,
                                              const ImuConsistencyParams& params) {
  const double without = mean_misfit(turns, params);
  double least = without, best_s = 0;
  const auto steps = std::lround(params.max_time_offset_s / params.time_offset_step_s);
  for (long step = -steps; step <= steps; ++step) {
    const double lag_s = static_cast<double>(step) * params.time_offset_step_s;
    const Turns shifted = turns_of(poses, samples, lag_s, noise, params);
    if (shifted.size() < turns.size() / 2) continue;
    const double misfit = mean_misfit(shifted, params);
    if (misfit < least) least = misfit, best_s = lag_s;
  }
  const bool shows = without > 1 && least < without / 2;
  if (!shows || std::abs(best_s) <= max_ignored_offset_s(poses, params)) return std::nullopt;
  return best_s;
}

std::optional<std::string> wrong_gravity(const std::vector<ImuSample>& samples, const ImuNoiseParams& noise,
                                         const ImuConsistencyParams& params) {
  std::vector<double> lengths;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t from = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    sum += samples[k].specific_force_mps2;
    const bool is_last = k + 1 == samples.size();
    if (!is_last && seconds_between(samples[from].stamp, samples[k].stamp) < params.force_window_s) continue;
    lengths.push_back((sum / static_cast<double>(k + 1 - from)).norm());
    sum.setZero();
    from = k + 1;
  }
  const double length = upper_median(std::move(lengths));
  if (std::abs(length - noise.gravity_mps2) <= params.max_gravity_error_mps2) return std::nullopt;
  const bool looks_like_g = std::abs(length - 1) < params.max_gravity_error_mps2 / noise.gravity_mps2;
  return "its accelerometer averages about " + rounded(length) + " m/s^2 instead of gravity's " +
         rounded(noise.gravity_mps2) + (looks_like_g ? ": are its values in g?" : "");
}

std::optional<std::string> wrong_rotation(const Turns& all, const ImuNoiseParams& noise,
                                          const ImuConsistencyParams& params) {
  const Turns turns = real_turns(all, params);
  const Eigen::Vector3d bias = median_bias(all);
  const double factor = turn_factor(turns);
  const bool is_scaled = std::abs(factor) > params.sigma_rotation_ratio && are_scaled(turns, factor, params);
  const bool is_whole = are_small(misfits(turns, bias, params), params);
  const bool is_near = bias.norm() <= params.sigmas * noise.sigma_gyroscope_bias_radps;
  if (is_whole && is_near) return std::nullopt;
  if (is_scaled && std::abs(factor - 1) > params.sigma_rotation_ratio)
    return "its gyroscope measures " + rounded(factor) +
           " times the rotation of its scans: are its values in rad/s and in the body frame?";
  if (is_whole) return "its gyroscope has a bias of " + rounded(bias.norm()) + " rad/s relative to its scans";
  return "its gyroscope contradicts the rotation of its scans: are its values in the body frame?";
}

}  // namespace

std::optional<std::string> find_inconsistency(const Trajectory<SE3>& poses,
                                              const std::vector<ImuSample>& samples,
                                              const ImuNoiseParams& noise,
                                              const ImuConsistencyParams& params) {
  if (samples.empty()) return std::nullopt;
  if (auto wrong = wrong_gravity(samples, noise, params)) return wrong;
  const Turns turns = turns_of(poses, samples, 0, noise, params);
  if (std::ssize(real_turns(turns, params)) < params.min_rotation_windows) return std::nullopt;
  if (const auto lag_s = significant_time_offset(poses, samples, turns, noise, params))
    return "its IMU samples are stamped " + rounded(std::abs(*lag_s)) + " s too " +
           (*lag_s > 0 ? "late" : "early") + " relative to its scans";
  return wrong_rotation(turns, noise, params);
}

}  // namespace radioslam
