#include "radioslam/radio/captures/clock_offset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "radioslam/base/parabola.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinRateSamples = 50;
constexpr std::size_t kParts = 10;
constexpr double kMinVariation = 0.3;  // standard deviation of the speed, relative to its mean

/// Rate of change of the channel at a time, in rad/s up to a factor.
struct RateSample {
  Stamp stamp;
  double channel_rate;
};

/// Distance between the channels at the ends of a window, at the window's middle: sqrt(1 - Re rho), rho their
/// complex correlation over the subcarriers.
std::vector<RateSample> channel_rates(const ChannelTrack& track, double window_s) {
  Eigen::MatrixXcd channel = track.channel;
  align_to_predecessors(channel, track.subcarrier_hz, packet_delays(track.subcarrier_hz), kNewestRatio);
  std::vector<RateSample> samples;
  Eigen::Index first = 0;
  for (Eigen::Index last = 1; last < channel.rows(); ++last) {
    const auto stamp = [&](Eigen::Index k) { return track.stamps[static_cast<std::size_t>(k)]; };
    while (seconds_between(stamp(first), stamp(last)) > window_s) ++first;
    const double size = channel.row(first).norm() * channel.row(last).norm();
    if (first == 0 || first == last || size == 0) continue;
    const double alike = channel.row(first).dot(channel.row(last)).real() / size;
    samples.push_back(
        {{stamp(first).ns + (stamp(last).ns - stamp(first).ns) / 2}, std::sqrt(std::max(0.0, 1 - alike))});
  }
  return samples;
}

/// Mean speed of the antenna in a window around a time; nothing outside the trajectory.
std::optional<double> speed_mps(const Trajectory<SE3>& trajectory, const Eigen::Vector3d& lever_m,
                                Stamp stamp, double window_s) {
  const auto half_ns = static_cast<std::int64_t>(window_s * 0.5e9);
  const auto before = trajectory.at({stamp.ns - half_ns}), after = trajectory.at({stamp.ns + half_ns});
  if (!before || !after) return std::nullopt;
  return (*after * lever_m - *before * lever_m).norm() / window_s;
}

/// Sums for a correlation, from which those of a part can be subtracted.
struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double a, double b) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  Sums without(const Sums& other) const {
    return {n - other.n, x - other.x, y - other.y, xx - other.xx, yy - other.yy, xy - other.xy};
  }
  /// Standard deviation of y, relative to its mean.
  double variation() const { return y > 0 ? std::sqrt(std::max(0.0, n * yy - y * y)) / y : 0; }
  double correlation() const {
    const double spread = (n * xx - x * x) * (n * yy - y * y);
    return spread > 0 ? (n * xy - x * y) / std::sqrt(spread) : 0;
  }
};

/// Position of the maximum in steps, interpolated.
double best_step(const std::vector<double>& values) {
  const auto best = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  if (best == 0 || best + 1 == values.size()) return static_cast<double>(best);
  return static_cast<double>(best) + parabola_peak(values[best - 1], values[best], values[best + 1]);
}

/// Half of the number of steps over which the values are close to the maximum.
double half_width(const std::vector<double>& values) {
  constexpr double kNearly = 0.95;
  const double nearly = kNearly * *std::max_element(values.begin(), values.end());
  const auto is_near = [&](double value) { return value >= nearly; };
  const auto first = std::find_if(values.begin(), values.end(), is_near);
  const auto last = std::find_if(values.rbegin(), values.rend(), is_near);
  return static_cast<double>(values.rend() - last - 1 - (first - values.begin())) / 2;
}

}  // namespace

ChannelTrack shifted(ChannelTrack track, double offset_s) {
  for (Stamp& stamp : track.stamps) stamp.ns += std::llround(offset_s * kNanosecondsPerSecond);
  return track;
}

ClockOffsetResult estimate_clock_offset(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                        const ClockOffsetParams& params) {
  if (!track.is_two_way) return {std::nullopt, ClockOffsetFailure::kNotTwoWay};
  if (track.stamps.size() < kMinRateSamples || trajectory.empty()) return {};
  const auto reach_ns = std::llround(params.max_s * kNanosecondsPerSecond);
  std::vector<RateSample> samples;
  for (const RateSample& sample : channel_rates(track, params.smoothing_s))
    if (speed_mps(trajectory, track.lever_arm_m, {sample.stamp.ns - reach_ns}, params.smoothing_s) &&
        speed_mps(trajectory, track.lever_arm_m, {sample.stamp.ns + reach_ns}, params.smoothing_s))
      samples.push_back(sample);
  if (samples.size() < kMinRateSamples) return {};
  const auto steps = static_cast<int>(std::lround(params.max_s / params.step_s));
  std::vector<double> whole;
  double min_variation = kMinVariation;
  std::vector<std::vector<double>> without(kParts);
  for (int step = -steps; step <= steps; ++step) {
    std::array<Sums, kParts> parts{};
    Sums all;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Stamp there{samples[k].stamp.ns + std::llround(step * params.step_s * kNanosecondsPerSecond)};
      const auto speed = speed_mps(trajectory, track.lever_arm_m, there, params.smoothing_s);
      if (!speed) continue;
      all.add(samples[k].channel_rate, *speed);
      parts[k * kParts / samples.size()].add(samples[k].channel_rate, *speed);
    }
    whole.push_back(all.correlation());
    min_variation = std::min(min_variation, all.variation());
    for (std::size_t part = 0; part < kParts; ++part)
      without[part].push_back(all.without(parts[part]).correlation());
  }
  const double best = best_step(whole);
  const bool is_inside = best > 0 && best < 2.0 * steps;
  const bool is_sharp = half_width(whole) * params.step_s <= params.max_peak_half_width_s;
  if (!is_inside || !is_sharp || min_variation < kMinVariation)
    return {std::nullopt, ClockOffsetFailure::kConstantSpeed};
  double scatter = 0;
  for (const auto& values : without) scatter += std::pow(best_step(values) - best, 2);
  const double sigma_s = std::max(std::sqrt((kParts - 1.0) / kParts * scatter), 0.5) * params.step_s;
  if (sigma_s > params.max_sigma_s) return {std::nullopt, ClockOffsetFailure::kConstantSpeed};
  return {ClockOffset{(best - steps) * params.step_s, sigma_s}, {}};
}

}  // namespace radioslam
