#include "radioslam/inertial/imu_outliers.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 3;    // on either side
constexpr std::size_t kSuspicious = 200;  // samples before which no share of outliers is suspicious

using Component = double (*)(const ImuSample& sample, Eigen::Index axis);

double force_of(const ImuSample& sample, Eigen::Index axis) { return sample.specific_force_mps2[axis]; }
double rate_of(const ImuSample& sample, Eigen::Index axis) { return sample.angular_rate_radps[axis]; }

bool is_possible(const ImuSample& sample, const ImuOutlierParams& params) {
  return sample.specific_force_mps2.norm() <= params.max_force_mps2 &&
         sample.angular_rate_radps.norm() <= params.max_rate_radps;  // false for NaN
}

/// Distance of a component of sample k from its neighbours' median, less `max_jump_mads` of their median
/// absolute deviations.
double excess(const std::vector<ImuSample>& samples, std::size_t k, Component component, Eigen::Index axis,
              double max_jump_mads) {
  const std::size_t begin = k - std::min(k, kNeighbours);
  const std::size_t end = std::min(samples.size(), k + kNeighbours + 1);
  std::vector<double> values;
  for (std::size_t n = begin; n < end; ++n) values.push_back(component(samples[n], axis));
  const double middle = upper_median(values);
  for (double& value : values) value = std::abs(value - middle);
  return std::abs(component(samples[k], axis) - middle) - max_jump_mads * upper_median(values);
}

bool is_spike(const std::vector<ImuSample>& samples, std::size_t k, const ImuOutlierParams& params) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (excess(samples, k, force_of, axis, params.max_jump_mads) > params.max_jump_mps2 ||
        excess(samples, k, rate_of, axis, params.max_jump_mads) > params.max_jump_radps)
      return true;
  return false;
}

}  // namespace

void ImuOutlierFilter::add(const ImuSample& sample, std::vector<ImuSample>& kept) {
  ++seen_;
  if (!is_suspicious() && !is_possible(sample, params_)) return void(++removed_);
  window_.push_back(sample);
  if (window_.size() > next_ + kNeighbours) judge(kept);
}

void ImuOutlierFilter::finish(std::vector<ImuSample>& kept) {
  while (next_ < window_.size()) judge(kept);
}

bool ImuOutlierFilter::is_suspicious() const {
  return seen_ >= kSuspicious &&
         static_cast<double>(removed_) > params_.max_outlier_ratio * static_cast<double>(seen_);
}

void ImuOutlierFilter::judge(std::vector<ImuSample>& kept) {
  if (!is_suspicious() && is_spike(window_, next_, params_))
    ++removed_;
  else
    kept.push_back(window_[next_]);
  if (++next_ > kNeighbours) window_.erase(window_.begin()), --next_;
}

FilteredImu remove_imu_outliers(const std::vector<ImuSample>& samples, const ImuOutlierParams& params) {
  FilteredImu filtered;
  ImuOutlierFilter filter(params);
  for (const ImuSample& sample : samples) filter.add(sample, filtered.samples);
  filter.finish(filtered.samples);
  filtered.removed = filter.removed();
  if (static_cast<double>(filtered.removed) > params.max_outlier_ratio * static_cast<double>(samples.size()))
    return {samples, 0};
  return filtered;
}

}  // namespace radioslam
