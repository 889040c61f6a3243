#include "radioslam/radio/fingerprints/distance_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr double kCell_m = 1;            // bin width of the histogram of distances
constexpr double kMinCommonness = 0.02;  // to the most common distance: weights differ by at most 50
constexpr double kStepsPerWindow = 100;
constexpr double kInformativeRatio = 2.0 / 3;  // to the mean distance of all samples

/// Inverse of the number of samples at about the same distance.
std::vector<double> even_weights(const std::vector<DistanceSample>& samples) {
  const auto cell = [](const DistanceSample& s) { return static_cast<std::size_t>(s.distance_m / kCell_m); };
  std::vector<double> counts;
  for (const auto& sample : samples) {
    if (counts.size() <= cell(sample)) counts.resize(cell(sample) + 1, 0);
    ++counts[cell(sample)];
  }
  const double most = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
  std::vector<double> weights;
  for (const auto& sample : samples)
    weights.push_back(1 / std::max(counts[cell(sample)], kMinCommonness * most));
  return weights;
}

/// Smallest similarity that is rounded to step k of the window.
double begin_of_step(std::size_t k, const DistanceModelParams& params) {
  return (static_cast<double>(k) - 0.5) * params.bin_width / kStepsPerWindow;
}

/// Mean and standard deviation of a unit Gaussian around `a`, truncated to positive values.
struct Moments {
  double mean, sigma;
};

Moments moments_of_truncated_gaussian(double a) {
  const double density = std::exp(-a * a / 2) / std::sqrt(2 * std::numbers::pi);
  const double kept = 0.5 * std::erfc(-a / std::numbers::sqrt2);
  const double hazard = density / kept;
  return {a + hazard, std::sqrt(std::max(0.0, 1 - a * hazard - hazard * hazard))};
}

constexpr std::size_t kMedianBins = 30;

// Near 1 the logarithm vanishes and noise dominates; near 0 only a few readings overlap.
constexpr double kMinSimilarity = 0.02;
constexpr double kMaxSimilarity = 0.9;
constexpr double kMinDistance_m = 2;

}  // namespace

PredictedDistance truncated_at_zero(double mean_m, double sigma_m, int samples) {
  constexpr int kBisections = 60;
  PredictedDistance p{mean_m, sigma_m, samples, 0, std::sqrt(mean_m * mean_m + sigma_m * sigma_m)};
  const Moments half = moments_of_truncated_gaussian(0);
  if (mean_m * half.sigma <= sigma_m * half.mean) return p;  // wider than half a Gaussian at zero
  const double ratio = mean_m / std::max(sigma_m, 1e-6 * mean_m);
  double low = 0, high = ratio;  // mean / sigma rises with a, and is at least a
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (low + high) / 2;
    const Moments m = moments_of_truncated_gaussian(middle);
    (m.mean < ratio * m.sigma ? low : high) = middle;
  }
  p.spread_m = mean_m / moments_of_truncated_gaussian(low).mean;
  p.peak_m = low * p.spread_m;
  return p;
}

DistanceModel::DistanceModel(std::vector<DistanceSample> samples, const DistanceModelParams& params)
    : params_(params), samples_(std::move(samples)) {
  std::sort(samples_.begin(), samples_.end(), [](const DistanceSample& a, const DistanceSample& b) {
    return std::tie(a.similarity, a.distance_m) < std::tie(b.similarity, b.distance_m);
  });
  const std::vector<double> weights =
      params_.even_distances ? even_weights(samples_) : std::vector<double>(samples_.size(), 1.0);
  weight_.assign(1, 0);
  sum_.assign(1, 0);
  sum_of_squares_.assign(1, 0);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const double d = samples_[i].distance_m, w = weights[i];
    weight_.push_back(weight_.back() + w);
    sum_.push_back(sum_.back() + w * d);
    sum_of_squares_.push_back(sum_of_squares_.back() + w * d * d);
  }
  const double step = params_.bin_width / kStepsPerWindow;
  for (std::size_t k = 0; begin_of_step(k, params_) < 1; ++k)
    steps_.push_back(predict_from_window(static_cast<double>(k) * step));
}

std::optional<PredictedDistance> DistanceModel::predict(double similarity) const {
  if (!(similarity >= 0)) return std::nullopt;
  const double step = std::round(std::min(similarity, 1.0) * kStepsPerWindow / params_.bin_width);
  return steps_[std::min(steps_.size() - 1, static_cast<std::size_t>(step))];
}

std::optional<PredictedDistance> DistanceModel::predict_from_window(double similarity) const {
  const double half = params_.bin_width / 2;
  const auto begin = std::lower_bound(samples_.begin(), samples_.end(), similarity - half,
                                      [](const DistanceSample& s, double v) { return s.similarity < v; });
  const auto end = std::upper_bound(begin, samples_.end(), similarity + half,
                                    [](double v, const DistanceSample& s) { return v < s.similarity; });
  const auto count = end - begin;
  if (count < params_.min_samples) return std::nullopt;
  const auto i = static_cast<std::size_t>(begin - samples_.begin());
  const auto j = static_cast<std::size_t>(end - samples_.begin());
  const double weight = weight_[j] - weight_[i];
  if (weight <= 0) return std::nullopt;
  const double mean = (sum_[j] - sum_[i]) / weight;
  const double variance = std::max(0.0, (sum_of_squares_[j] - sum_of_squares_[i]) / weight - mean * mean);
  return truncated_at_zero(mean, std::sqrt(variance), static_cast<int>(count));
}

std::optional<double> DistanceModel::min_similarity_below(double distance_m) const {
  constexpr double kRoundingMargin = 1e-9;
  for (std::size_t k = 0; k < steps_.size(); ++k)
    if (steps_[k] && steps_[k]->mean_m < distance_m) return begin_of_step(k, params_) - kRoundingMargin;
  return std::nullopt;
}

std::optional<double> DistanceModel::smallest_distance_m() const {
  const double informative_m = kInformativeRatio * sum_.back() / weight_.back();  // NaN without samples
  std::optional<double> smallest;
  for (const auto& p : steps_)
    if (p && p->mean_m < informative_m) smallest = std::min(p->mean_m, smallest.value_or(p->mean_m));
  return smallest;
}

double DecayModel::distance_m(double s) const { return std::max(kNearest_m, -length_m * std::log(s)); }

std::optional<DecayModel> fit_decay(const std::vector<DistanceSample>& samples, int min_samples) {
  std::vector<double> lengths;
  for (const auto& [similarity, distance] : samples)
    if (similarity > kMinSimilarity && similarity < kMaxSimilarity && distance > kMinDistance_m)
      lengths.push_back(distance / -std::log(similarity));
  if (static_cast<int>(lengths.size()) < min_samples) return std::nullopt;
  return DecayModel{upper_median(std::move(lengths))};
}

std::optional<MedianModel> MedianModel::fit(std::vector<DistanceSample> samples, int min_samples) {
  const auto least = static_cast<std::size_t>(min_samples);
  if (samples.size() < std::max<std::size_t>(least, 1)) return std::nullopt;
  std::sort(samples.begin(), samples.end(), [](const DistanceSample& a, const DistanceSample& b) {
    return std::tie(a.similarity, a.distance_m) < std::tie(b.similarity, b.distance_m);
  });
  const std::size_t bins = std::clamp<std::size_t>(samples.size() / least, 1, kMedianBins);
  MedianModel model;
  std::vector<double> pooled;  // bins that each entry stands for
  for (std::size_t k = 0; k < bins; ++k) {
    std::vector<double> similarities, distances;
    for (std::size_t i = k * samples.size() / bins; i < (k + 1) * samples.size() / bins; ++i) {
      similarities.push_back(samples[i].similarity);
      distances.push_back(samples[i].distance_m);
    }
    double similarity = upper_median(std::move(similarities)), distance = upper_median(std::move(distances));
    double count = 1;
    for (; !pooled.empty() && model.distances_m_.back() < distance; pooled.pop_back()) {
      const double before = pooled.back();
      similarity = (similarity * count + model.similarities_.back() * before) / (count + before);
      distance = (distance * count + model.distances_m_.back() * before) / (count + before);
      count += before;
      model.similarities_.pop_back();
      model.distances_m_.pop_back();
    }
    model.similarities_.push_back(similarity);
    model.distances_m_.push_back(distance);
    pooled.push_back(count);
  }
  return model;
}

double MedianModel::distance_m(double similarity) const {
  const auto next = std::upper_bound(similarities_.begin(), similarities_.end(), similarity);
  if (next == similarities_.begin()) return distances_m_.front();
  if (next == similarities_.end()) return distances_m_.back();
  const auto k = static_cast<std::size_t>(next - similarities_.begin());
  const double along = (similarity - similarities_[k - 1]) / (similarities_[k] - similarities_[k - 1]);
  return distances_m_[k - 1] + along * (distances_m_[k] - distances_m_[k - 1]);
}

}  // namespace radioslam
