#include "radioslam/inertial/wild_readings.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 3;  // on either side

using Component = double (*)(const InertialSample& sample, Eigen::Index axis);

double force_of(const InertialSample& sample, Eigen::Index axis) { return sample.specific_force_mps2[axis]; }
double rate_of(const InertialSample& sample, Eigen::Index axis) { return sample.angular_rate_radps[axis]; }

bool is_possible(const InertialSample& sample, const WildReadingParams& params) {
  return sample.specific_force_mps2.norm() <= params.most_force_mps2 &&
         sample.angular_rate_radps.norm() <= params.most_rate_radps;  // not where it is no number
}

/// How far a component of reading k is from those about it, less `spreads` of theirs.
double excess(const std::vector<InertialSample>& samples, std::size_t k, Component component,
              Eigen::Index axis, double spreads) {
  const std::size_t begin = k - std::min(k, kNeighbours);
  const std::size_t end = std::min(samples.size(), k + kNeighbours + 1);
  std::vector<double> values;
  for (std::size_t n = begin; n < end; ++n) values.push_back(component(samples[n], axis));
  const double middle = upper_median(values);
  for (double& value : values) value = std::abs(value - middle);
  return std::abs(component(samples[k], axis) - middle) - spreads * upper_median(values);
}

bool stands_alone(const std::vector<InertialSample>& samples, std::size_t k,
                  const WildReadingParams& params) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (excess(samples, k, force_of, axis, params.spreads) > params.jump_mps2 ||
        excess(samples, k, rate_of, axis, params.spreads) > params.jump_radps)
      return true;
  return false;
}

}  // namespace

TameReadings leave_out_wild(const std::vector<InertialSample>& samples, const WildReadingParams& params) {
  std::vector<InertialSample> possible;
  for (const InertialSample& sample : samples)
    if (is_possible(sample, params)) possible.push_back(sample);
  TameReadings tame;
  for (std::size_t k = 0; k < possible.size(); ++k)
    if (!stands_alone(possible, k, params)) tame.samples.push_back(possible[k]);
  tame.left_out = samples.size() - tame.samples.size();
  if (static_cast<double>(tame.left_out) > params.most_share * static_cast<double>(samples.size()))
    return {samples, 0};
  return tame;
}

}  // namespace radioslam
