#include "radioslam/radio/clock_offset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "radioslam/base/parabola.hpp"
#include "radioslam/radio/arrival_slopes.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kFewestMoments = 50;
constexpr std::size_t kParts = 10;
constexpr double kLeastVariation = 0.3;  // of the speed, to its mean

/// A time and how fast the channel changed then, in radians a second up to a factor.
struct Moment {
  Stamp stamp;
  double channel_rate;
};

/// How far the channel is from where it was the smoothing time before, at the middle of that time:
/// sqrt(1 - Re rho), rho the correlation of the two over the subcarriers, their phase included.
std::vector<Moment> channel_rates(const ChannelTrack& track, double window_s) {
  Eigen::MatrixXcd channel = track.channel;
  align_to_predecessors(channel, track.subcarrier_hz, packet_delays(track.subcarrier_hz), kNewestShare);
  std::vector<Moment> moments;
  Eigen::Index first = 0;
  for (Eigen::Index last = 1; last < channel.rows(); ++last) {
    const auto stamp = [&](Eigen::Index k) { return track.stamps[static_cast<std::size_t>(k)]; };
    while (seconds_between(stamp(first), stamp(last)) > window_s) ++first;
    const double size = channel.row(first).norm() * channel.row(last).norm();
    if (first == 0 || first == last || size == 0) continue;
    const double alike = channel.row(first).dot(channel.row(last)).real() / size;
    moments.push_back(
        {{stamp(first).ns + (stamp(last).ns - stamp(first).ns) / 2}, std::sqrt(std::max(0.0, 1 - alike))});
  }
  return moments;
}

/// Metres a second of the antenna around a time; nothing outside the trajectory.
std::optional<double> speed_mps(const Trajectory<SE3>& trajectory, const Eigen::Vector3d& lever_m,
                                Stamp stamp, double window_s) {
  const auto half_ns = static_cast<std::int64_t>(window_s * 0.5e9);
  const auto before = trajectory.at({stamp.ns - half_ns}), after = trajectory.at({stamp.ns + half_ns});
  if (!before || !after) return std::nullopt;
  return (*after * lever_m - *before * lever_m).norm() / window_s;
}

/// Sums from which a correlation follows, and from which a part can be taken off.
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
  /// Of y, to its mean.
  double variation() const { return y > 0 ? std::sqrt(std::max(0.0, n * yy - y * y)) / y : 0; }
  double correlation() const {
    const double spread = (n * xx - x * x) * (n * yy - y * y);
    return spread > 0 ? (n * xy - x * y) / std::sqrt(spread) : 0;
  }
};

/// Where the values are largest, refined between the steps, in steps.
double best_step(const std::vector<double>& values) {
  const auto best = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  if (best == 0 || best + 1 == values.size()) return static_cast<double>(best);
  return static_cast<double>(best) + parabola_peak(values[best - 1], values[best], values[best + 1]);
}

/// Half of the steps over which these are nearly as large as the largest.
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
  for (Stamp& stamp : track.stamps) stamp.ns += std::llround(offset_s * 1e9);
  return track;
}

ClockOffsetResult estimate_clock_offset(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                        const ClockOffsetParams& params) {
  if (!track.is_two_way) return {std::nullopt, NoClockOffset::kNotTwoWay};
  if (track.stamps.size() < kFewestMoments || trajectory.empty()) return {};
  const auto reach_ns = std::llround(params.most_s * 1e9);
  std::vector<Moment> moments;
  for (const Moment& moment : channel_rates(track, params.smoothing_s))
    if (speed_mps(trajectory, track.lever_arm_m, {moment.stamp.ns - reach_ns}, params.smoothing_s) &&
        speed_mps(trajectory, track.lever_arm_m, {moment.stamp.ns + reach_ns}, params.smoothing_s))
      moments.push_back(moment);
  if (moments.size() < kFewestMoments) return {};
  const auto steps = static_cast<int>(std::lround(params.most_s / params.step_s));
  std::vector<double> whole;
  double least_variation = kLeastVariation;
  std::vector<std::vector<double>> without(kParts);
  for (int step = -steps; step <= steps; ++step) {
    std::array<Sums, kParts> parts{};
    Sums all;
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const Stamp there{moments[k].stamp.ns + std::llround(step * params.step_s * 1e9)};
      const auto speed = speed_mps(trajectory, track.lever_arm_m, there, params.smoothing_s);
      if (!speed) continue;
      all.add(moments[k].channel_rate, *speed);
      parts[k * kParts / moments.size()].add(moments[k].channel_rate, *speed);
    }
    whole.push_back(all.correlation());
    least_variation = std::min(least_variation, all.variation());
    for (std::size_t part = 0; part < kParts; ++part)
      without[part].push_back(all.without(parts[part]).correlation());
  }
  const double best = best_step(whole);
  const bool is_inside = best > 0 && best < 2.0 * steps;
  const bool is_sharp = half_width(whole) * params.step_s <= params.widest_peak_s;
  if (!is_inside || !is_sharp || least_variation < kLeastVariation)
    return {std::nullopt, NoClockOffset::kConstantSpeed};
  double scatter = 0;
  for (const auto& values : without) scatter += std::pow(best_step(values) - best, 2);
  const double sigma_s = std::max(std::sqrt((kParts - 1.0) / kParts * scatter), 0.5) * params.step_s;
  if (sigma_s > params.widest_s) return {std::nullopt, NoClockOffset::kConstantSpeed};
  return {ClockOffset{(best - steps) * params.step_s, sigma_s}, {}};
}

}  // namespace radioslam
