#include "radioslam/mission/step_detection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace radioslam {
namespace {

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

}  // namespace

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

}  // namespace radioslam
