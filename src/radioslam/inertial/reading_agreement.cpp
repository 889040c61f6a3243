#include "radioslam/inertial/reading_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "radioslam/base/median.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/inertial/reading_intervals.hpp"

namespace radioslam {
namespace {

constexpr double kLongestWindow = 3;  // a window more than so many times too long spans a gap

std::string rounded(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

/// A turn as poses and gyroscope tell it.
struct Turn {
  Stamp begin, end;
  Eigen::Vector3d by_poses, by_gyroscope;
  Eigen::Vector3d rates_sum;  ///< of the gyroscope, times time: beyond half a turn too

  double duration_s() const { return seconds_between(begin, end); }
};
using Turns = std::vector<Turn>;

/// From one pose to the other, each reading taken as `lag_ns` late.
std::optional<Turn> turn_between(const StampedPose<SE3>& begin, const StampedPose<SE3>& end,
                                 const std::vector<InertialSample>& samples, std::int64_t lag_ns,
                                 double longest_gap_s) {
  const auto pieces =
      reading_intervals(samples, {begin.stamp.ns + lag_ns}, {end.stamp.ns + lag_ns}, longest_gap_s);
  if (!pieces) return std::nullopt;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ReadingInterval& piece : *pieces) {
    const Eigen::Vector3d turn = piece.duration_s * piece.angular_rate_radps;
    rotation = rotation * so3_exp(turn);
    sum += turn;
  }
  return Turn{begin.stamp, end.stamp, so3_log(begin.pose.rotation().conjugate() * end.pose.rotation()),
              so3_log(rotation.normalized()), sum};
}

Turns turns_of(const Trajectory<SE3>& poses, const std::vector<InertialSample>& samples, double lag_s,
               const InertialNoiseParams& noise, const ReadingAgreementParams& params) {
  Turns turns;
  const std::int64_t lag_ns = Stamp::from_seconds(lag_s).ns;
  std::size_t from = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double duration_s = seconds_between(poses[from].stamp, poses[k].stamp);
    if (duration_s < params.window_s) continue;
    const std::size_t begin = std::exchange(from, k);
    if (duration_s > kLongestWindow * params.window_s) continue;
    if (const auto turn = turn_between(poses[begin], poses[k], samples, lag_ns, noise.longest_gap_s))
      turns.push_back(*turn);
  }
  return turns;
}

double variance_of(const Turn& turn, const ReadingAgreementParams& params) {
  const double by_share = params.sigma_turn_share * turn.by_poses.norm();
  return 2 * params.sigma_turn_rad * params.sigma_turn_rad + by_share * by_share;
}

/// Those in which the body turns, by either.
Turns real_turns(const Turns& turns, const ReadingAgreementParams& params) {
  const double least_rad = params.sigmas * params.sigma_turn_rad;
  Turns real;
  for (const Turn& turn : turns)
    if (std::max(turn.by_poses.norm(), turn.by_gyroscope.norm()) > least_rad) real.push_back(turn);
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

/// |r|^2 / sigma^2 of each.
std::vector<double> misfits(const Turns& turns, const Eigen::Vector3d& bias,
                            const ReadingAgreementParams& params) {
  std::vector<double> result;
  for (const Turn& turn : turns) {
    const Eigen::Vector3d left = turn.by_gyroscope - turn.duration_s() * bias - turn.by_poses;
    result.push_back(left.squaredNorm() / variance_of(turn, params));
  }
  return result;
}

bool are_small(std::vector<double> misfits, const ReadingAgreementParams& params) {
  return upper_median(std::move(misfits)) <= 3 * params.sigmas * params.sigmas;
}

/// How many times as much the gyroscope turns.
double turn_factor(const Turns& turns) {
  double both = 0, poses = 0;
  for (const Turn& turn : turns) {
    both += turn.rates_sum.dot(turn.by_poses);
    poses += turn.by_poses.squaredNorm();
  }
  return poses > 0 ? both / poses : 1;
}

bool are_scaled(const Turns& turns, double factor, const ReadingAgreementParams& params) {
  std::vector<double> misfits;
  for (const Turn& turn : turns)
    misfits.push_back((turn.rates_sum / factor - turn.by_poses).squaredNorm() / variance_of(turn, params));
  return are_small(std::move(misfits), params);
}

double harmless_lag_s(const Trajectory<SE3>& poses, const ReadingAgreementParams& params) {
  std::vector<double> steps_s;
  for (std::size_t k = 1; k < poses.size(); ++k)
    steps_s.push_back(seconds_between(poses[k - 1].stamp, poses[k].stamp));
  return std::max(params.harmless_lag_s, params.harmless_lag_steps * upper_median(std::move(steps_s)));
}

/// A sum per turn, of which none counts for more than `sigmas`.
double mean_misfit(const Turns& all, const ReadingAgreementParams& params) {
  const Turns turns = real_turns(all, params);
  double sum = 0;
  for (const double misfit : misfits(turns, median_bias(all), params))
    sum += std::min(misfit, params.sigmas * params.sigmas);
  return sum / static_cast<double>(std::max<std::size_t>(1, turns.size()));
}

/// By how much the readings are stamped late, where that shows.
std::optional<double> clear_lag(const Trajectory<SE3>& poses, const std::vector<InertialSample>& samples,
                                const Turns& turns, const InertialNoiseParams& noise,
                                const ReadingAgreementParams& params) {
  const double without = mean_misfit(turns, params);
  double least = without, best_s = 0;
  const auto steps = std::lround(params.longest_lag_s / params.lag_step_s);
  for (long step = -steps; step <= steps; ++step) {
    const double lag_s = static_cast<double>(step) * params.lag_step_s;
    const Turns shifted = turns_of(poses, samples, lag_s, noise, params);
    if (shifted.size() < turns.size() / 2) continue;
    const double misfit = mean_misfit(shifted, params);
    if (misfit < least) least = misfit, best_s = lag_s;
  }
  const bool shows = without > 1 && least < without / 2;
  if (!shows || std::abs(best_s) <= harmless_lag_s(poses, params)) return std::nullopt;
  return best_s;
}

std::optional<std::string> wrong_force(const std::vector<InertialSample>& samples,
                                       const InertialNoiseParams& noise,
                                       const ReadingAgreementParams& params) {
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
  if (std::abs(length - noise.gravity_mps2) <= params.largest_gravity_error_mps2) return std::nullopt;
  const bool looks_like_g = std::abs(length - 1) < params.largest_gravity_error_mps2 / noise.gravity_mps2;
  return "its accelerometer measures about " + rounded(length) + " m/s^2, not gravity's " +
         rounded(noise.gravity_mps2) + (looks_like_g ? ": is it in g?" : "");
}

std::optional<std::string> wrong_turns(const Turns& all, const InertialNoiseParams& noise,
                                       const ReadingAgreementParams& params) {
  const Turns turns = real_turns(all, params);
  const Eigen::Vector3d bias = median_bias(all);
  const double factor = turn_factor(turns);
  const bool is_scaled = std::abs(factor) > params.sigma_turn_share && are_scaled(turns, factor, params);
  const bool is_whole = are_small(misfits(turns, bias, params), params);
  const bool is_near = bias.norm() <= params.sigmas * noise.sigma_gyroscope_bias_radps;
  if (is_whole && is_near) return std::nullopt;
  if (is_scaled && std::abs(factor - 1) > params.sigma_turn_share)
    return "its gyroscope turns " + rounded(factor) +
           " times as much as its scans: is it in rad/s, and in the body's frame?";
  if (is_whole) return "its gyroscope is off by " + rounded(bias.norm()) + " rad/s from its scans";
  return "its gyroscope does not turn as its scans do: is it in the body's frame?";
}

}  // namespace

std::optional<std::string> disagreement(const Trajectory<SE3>& poses,
                                        const std::vector<InertialSample>& samples,
                                        const InertialNoiseParams& noise,
                                        const ReadingAgreementParams& params) {
  if (samples.empty()) return std::nullopt;
  if (auto wrong = wrong_force(samples, noise, params)) return wrong;
  const Turns turns = turns_of(poses, samples, 0, noise, params);
  if (std::ssize(real_turns(turns, params)) < params.least_turns) return std::nullopt;
  if (const auto lag_s = clear_lag(poses, samples, turns, noise, params))
    return "its readings are stamped " + rounded(std::abs(*lag_s)) + " s too " +
           (*lag_s > 0 ? "late" : "early") + " for its scans";
  return wrong_turns(turns, noise, params);
}

}  // namespace radioslam
