#include "radioslam/mission/sweep_slices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr std::size_t kMinSlices = 6;
constexpr double kMaxArc_rad = 200 * kRadiansPerDegree;  ///< half a sweep, and a margin
constexpr double kMinStepPerArc = 0.25;                  ///< neighbours may overlap, but not mostly
constexpr double kMinRegularShare = 0.7;                 ///< of steps within half a step of the typical one
constexpr double kMissingSlice = 1.6;                    ///< times the usual interval
constexpr double kMaxPeriod_s = 2;                       ///< slower turns are the robot's

double wrapped(double angle_rad) { return std::remainder(angle_rad, kTurn_rad); }

/// A scan's azimuths: the shortest arc that contains all points.
struct Arc {
  double middle_rad = 0, width_rad = 0;
};

/// Nothing without a point that has an azimuth.
std::optional<Arc> arc_of(const LidarScan& scan) {
  std::vector<double> azimuths;
  for (const Eigen::Vector3f& point : scan.points)
    if (point.allFinite() && !point.head<2>().isZero(0))
      azimuths.push_back(std::atan2(static_cast<double>(point.y()), static_cast<double>(point.x())));
  if (azimuths.empty()) return std::nullopt;
  std::sort(azimuths.begin(), azimuths.end());
  double begin = azimuths.front(), gap = azimuths.front() + kTurn_rad - azimuths.back();
  for (std::size_t k = 1; k < azimuths.size(); ++k)
    if (azimuths[k] - azimuths[k - 1] > gap) {
      gap = azimuths[k] - azimuths[k - 1];
      begin = azimuths[k];
    }
  const double width = kTurn_rad - gap;
  return Arc{wrapped(begin + width / 2), width};
}

/// The angle with the least sum of distances to all.
double circular_median(const std::vector<double>& angles_rad) {
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const double candidate : angles_rad) {
    double sum = 0;
    for (const double angle : angles_rad) sum += std::abs(wrapped(angle - candidate));
    if (sum < least) {
      least = sum;
      best = candidate;
    }
  }
  return best;
}

/// The typical speed of the turn; every step is unwrapped to be nearest the typical one.
double rate_of(const std::vector<double>& steps_rad, const std::vector<Stamp>& stamps, double step_rad) {
  std::vector<double> rates;
  for (std::size_t k = 0; k < steps_rad.size(); ++k)
    if (const double seconds = seconds_between(stamps[k], stamps[k + 1]); seconds > 0)
      rates.push_back((step_rad + wrapped(steps_rad[k] - step_rad)) / seconds);
  return rates.empty() ? 0 : upper_median(rates);
}

/// The mean of the steps near the typical one; nothing if these are too few.
std::optional<double> regular_step(const std::vector<double>& steps_rad) {
  const double typical = circular_median(steps_rad);
  double sum = 0;
  std::size_t regular = 0;
  for (const double step : steps_rad) {
    const double off = wrapped(step - typical);
    if (std::abs(off) > std::abs(typical) / 2) continue;
    sum += off;
    ++regular;
  }
  if (static_cast<double>(regular) < kMinRegularShare * static_cast<double>(steps_rad.size()))
    return std::nullopt;
  return typical + sum / static_cast<double>(regular);
}

bool are_equal(const StampedScan& a, const StampedScan& b) {
  return a.stamp == b.stamp && a.scan.points == b.scan.points;
}

/// Joins slices, which are in time order.
StampedScan joined(const std::vector<StampedScan>& slices) {
  StampedScan sweep{slices.front().stamp, {}};
  const bool has_times = slices.back().stamp != sweep.stamp ||
                         std::any_of(slices.begin(), slices.end(),
                                     [](const auto& slice) { return !slice.scan.times_s.empty(); });
  const bool has_intensities = std::all_of(slices.begin(), slices.end(), [](const auto& slice) {
    return slice.scan.intensities.size() == slice.scan.points.size();
  });
  for (const StampedScan& slice : slices) {
    const auto offset_s = static_cast<float>(seconds_between(sweep.stamp, slice.stamp));
    for (std::size_t k = 0; k < slice.scan.points.size(); ++k) {
      sweep.scan.points.push_back(slice.scan.points[k]);
      const float time_s = slice.scan.times_s.empty() ? 0 : slice.scan.times_s[k];
      if (has_times) sweep.scan.times_s.push_back(offset_s + time_s);
      if (has_intensities) sweep.scan.intensities.push_back(slice.scan.intensities[k]);
    }
  }
  return sweep;
}

}  // namespace

std::optional<SliceMotion> motion_of_slices(std::span<const StampedScan> slices) {
  std::vector<Arc> arcs;
  std::vector<double> widths, steps;
  std::vector<Stamp> stamps;
  for (const StampedScan& slice : slices)
    if (const auto arc = arc_of(slice.scan)) {
      if (!arcs.empty()) steps.push_back(wrapped(arc->middle_rad - arcs.back().middle_rad));
      arcs.push_back(*arc);
      widths.push_back(arc->width_rad);
      stamps.push_back(slice.stamp);
    }
  if (arcs.size() < kMinSlices) return std::nullopt;
  const auto regular = regular_step(steps);
  if (!regular) return std::nullopt;
  const double step = *regular;
  const double width = upper_median(widths);
  const bool is_stepping = step != 0 && std::abs(step) >= kMinStepPerArc * width && width <= kMaxArc_rad;
  const double rate = rate_of(steps, stamps, step);
  const bool is_slow = rate != 0 && kTurn_rad / std::abs(rate) > kMaxPeriod_s;
  if (!is_stepping || is_slow) return std::nullopt;
  std::vector<double> begins;  // of the first slice, as each of them says
  double turned = 0;
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    if (k > 0) turned += step + wrapped(steps[k - 1] - step);
    begins.push_back(wrapped(arcs[k].middle_rad - std::round(turned / step) * step));
  }
  return SliceMotion{step, rate, circular_median(begins) - step / 2};
}

/// Unwraps the azimuth from that of the last slice; the time between them says how many turns are missing.
long SweepAssembler::revolution_of(double azimuth_rad, Stamp stamp) {
  const double sign = motion_.step_rad < 0 ? -1 : 1;
  const double since_begin = sign * (azimuth_rad - motion_.begin_rad);
  const double expected = std::abs(motion_.rate_radps) * seconds_between(last_stamp_, stamp);
  const double nominal = std::abs(motion_.step_rad);
  const double step = nominal + wrapped(since_begin - last_rad_ - nominal);
  const double turns = motion_.rate_radps == 0 ? 0 : std::round((expected - step) / kTurn_rad);
  const double unwrapped = has_last_ ? last_rad_ + step + turns * kTurn_rad
                                     : since_begin - std::floor(since_begin / kTurn_rad) * kTurn_rad;
  if (has_last_ && turns == 0 && expected > kMissingSlice * nominal)
    counts_.missing += static_cast<std::size_t>(std::round(expected / nominal)) - 1;
  if (has_last_ && unwrapped < last_rad_ - nominal / 2 && counts_.missing > 0)
    --counts_.missing;  // it comes after its successor
  if (!has_last_ || unwrapped > last_rad_) {
    last_rad_ = unwrapped;
    last_stamp_ = stamp;
  }
  has_last_ = true;
  return static_cast<long>(std::floor(unwrapped / kTurn_rad));
}

std::vector<StampedScan> SweepAssembler::add(StampedScan slice) {
  const auto arc = arc_of(slice.scan);
  ++counts_.slices;
  if (!arc) return ++counts_.empty, std::vector<StampedScan>{};
  const long revolution = revolution_of(arc->middle_rad, slice.stamp);
  if (revolution < complete_) return ++counts_.late, std::vector<StampedScan>{};
  std::vector<StampedScan>& sweep = sweeps_[revolution];
  if (std::any_of(sweep.begin(), sweep.end(), [&](const auto& other) { return are_equal(other, slice); }))
    return ++counts_.repeated, std::vector<StampedScan>{};
  const auto place =
      std::upper_bound(sweep.begin(), sweep.end(), slice.stamp,
                       [](Stamp stamp, const StampedScan& other) { return stamp < other.stamp; });
  sweep.insert(place, std::move(slice));
  return take_before(sweeps_.rbegin()->first - 1);
}

std::vector<StampedScan> SweepAssembler::finish() { return take_before(std::numeric_limits<long>::max()); }

std::vector<StampedScan> SweepAssembler::take_before(long revolution) {
  std::vector<StampedScan> complete;
  while (!sweeps_.empty() && sweeps_.begin()->first < revolution) {
    complete.push_back(joined(sweeps_.begin()->second));
    complete_ = sweeps_.begin()->first + 1;
    sweeps_.erase(sweeps_.begin());
    ++counts_.sweeps;
  }
  return complete;
}

}  // namespace radioslam
