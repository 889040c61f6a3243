#include "radioslam/team_frame/measurement_mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <type_traits>

#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/loss.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/team_frame/level_view.hpp"
#include "radioslam/team_frame/line_of_sight/detour_continuity.hpp"

namespace radioslam {
namespace {

template <class Pose>
void discount(const PoseGraph<Pose>& graph, auto& factor) {
  const double ratio = 1 - (1 - factor.weight) * squared_norm(graph, factor);
  factor.weight *= std::clamp(ratio, 0.0, 1.0);
}

}  // namespace

template <class Pose>
void use_observed_information(PoseGraph<Pose>& graph, const std::vector<std::size_t>& ranges,
                              double sigma_antenna_position_m) {
  for (const std::size_t k : ranges) discount(graph, graph.ranges[k]);
  for (auto& bearing : graph.bearings) {
    discount(graph, bearing);
    const double across = bearing.sigma_rad * seen_by_receiver(graph, bearing).norm();
    bearing.weight *=
        across * across / (across * across + sigma_antenna_position_m * sigma_antenna_position_m);
  }
}

template void use_observed_information(PoseGraph<SE2>&, const std::vector<std::size_t>&, double);
template void use_observed_information(PoseGraph<SE3>&, const std::vector<std::size_t>&, double);

namespace {

constexpr double kReachOverItsSigma = 4;
/// Weight of the prior of the obstructed share, in measurements.
constexpr double kPriorMeasurements = 2;
constexpr double kMaxObstructedShare = 0.98;
constexpr double kMinObstructedShare = 1e-4;
constexpr double kShareTolerance = 1e-3;
/// Links, or other factors, per task: some tenth of a millisecond.
constexpr std::size_t kLinksPerTask = 512;

double added(const std::vector<double>& inflation, std::size_t k, double inflation_scale) {
  return inflation.empty() ? 0 : inflation_scale * inflation[k];
}

double density_of_normal(double squared_norm, double sigma) {
  return unit_normal(squared_norm) / (std::sqrt(2 * std::numbers::pi) * sigma);
}

/// Density of a direction relative to the uniform density, of azimuths or over the sphere.
double direction_density(double squared_norm, double sigma, bool azimuth_only) {
  const double peak = azimuth_only ? std::sqrt(2 * std::numbers::pi) / sigma : 2 / (sigma * sigma);
  return peak * unit_normal(squared_norm);
}

template <class Pose>
bool is_azimuth(const BearingFactor<Pose>& factor) {
  return Pose::kDim == 2 || factor.azimuth_only;
}

/// A density of this height, or zero, after its variance grew; of a normal density exactly.
double widened(double density, double added_variance) {
  return density / std::sqrt(1 + 2 * std::numbers::pi * density * density * added_variance);
}

/// Densities of the direct and the outlier term.
std::array<double, 2> range_densities(double error_m, double sigma_m, double span_m,
                                      const MixtureParams& params) {
  const double error = error_m / sigma_m;
  return {(1 - params.false_range_probability) * density_of_normal(error * error, sigma_m),
          params.false_range_probability / span_m};
}

}  // namespace

template <class Pose>
std::vector<double> path_priors(const AmbiguousBearing<Pose>& bearing, const MixtureParams& params) {
  std::vector<double> priors;
  double strongest_db = bearing.paths.front().power_db, sum = 0;
  for (const auto& path : bearing.paths) strongest_db = std::max(strongest_db, path.power_db);
  for (const auto& path : bearing.paths) {
    priors.push_back(std::exp2((path.power_db - strongest_db) / params.power_for_double_db));
    sum += priors.back();
  }
  for (double& prior : priors) prior /= sum;
  return priors;
}

/// Of all measurements, ranges before bearings; of all paths of the bearings.
template <class Pose>
struct MixtureGraph<Pose>::Densities {
  Densities(std::size_t ranges, std::size_t bearings, std::size_t paths)
      : sight(ranges + bearings),
        range_sigma(ranges),
        range_direct(ranges),
        range_longer(ranges),
        path_sigma(paths),
        path_direct(paths),
        detours(ranges),
        log_within_reach(bearings) {}

  std::vector<SightDensities> sight;
  std::vector<double> range_sigma;
  std::vector<double> range_direct, range_longer;  ///< terms of the densities in sight and obstructed
  std::vector<double> path_sigma, path_direct;
  std::vector<ObstructedRange> detours;
  std::vector<double> log_within_reach;  ///< per bearing

  double sum_within_reach() const {
    return std::accumulate(log_within_reach.begin(), log_within_reach.end(), 0.0);
  }
};

template <class Pose>
MixtureGraph<Pose>::MixtureGraph(const TeamGraph<Pose>& team, const MixtureParams& params)
    : graph(team.graph),
      params_(params),
      chains_(team, params.sight_time_s),
      obstructed_share_(params.obstructed_share) {
  for (const auto& range : graph.ranges) {
    range_m_.push_back(range.range_m);
    range_sigma_.push_back(range.sigma_m);
    range_weight_.push_back(1);
    span_m_ = std::max(span_m_, range.range_m);
  }
  first_path_.push_back(0);
  for (const auto& bearing : team.bearings) {
    const auto priors = path_priors(bearing, params);
    for (std::size_t p = 0; p < priors.size(); ++p) {
      graph.bearings.push_back(path_factor(bearing, p));
      path_sigma_.push_back(bearing.paths[p].sigma_rad);
      path_prior_.push_back(priors[p]);
    }
    first_path_.push_back(graph.bearings.size());
  }
  if (params.obstructed_share > 0)
    detour_density_ =
        detour_densities(team, path_prior_, {span_m_, params.sight_time_s, params.direct_probability});
  else
    detour_density_.assign(graph.ranges.size(), 0);
}

template <class Pose>
void MixtureGraph<Pose>::weigh_range(std::size_t k, double inflation_m2, Densities& result) const {
  const auto& factor = graph.ranges[k];
  const double sigma = std::sqrt(range_sigma_[k] * range_sigma_[k] + inflation_m2);
  const double error = residual(graph, factor)[0] + factor.range_m - range_m_[k];
  const auto [direct, wrong] = range_densities(error, sigma, span_m_, params_);
  ObstructedRange detour;
  if (obstructed_share_ > 0) detour = obstructed_range(-error, sigma);
  const double longer =
      (1 - params_.false_range_probability) * widened(detour_density_[k], inflation_m2) * detour.probability;
  result.sight[k] = {direct + wrong, longer + wrong};
  result.range_longer[k] = longer;
  result.range_sigma[k] = sigma;
  result.range_direct[k] = direct;
  result.detours[k] = detour;
}

template <class Pose>
void MixtureGraph<Pose>::weigh_bearing(std::size_t b, double inflation_rad2, Densities& result) const {
  double total = 1 - params_.direct_probability;
  for (std::size_t p = first_path_[b]; p < first_path_[b + 1]; ++p) {
    const bool azimuth = is_azimuth(graph.bearings[p]);
    const typename Pose::Point seen = seen_by_receiver(graph, graph.bearings[p]);
    const double by_places = params_.sigma_antenna_position_m / std::max(seen.norm(), kMinimumDistance_m);
    const double sigma =
        std::min(azimuth ? kWidestAzimuth_rad : kWidestDirection_rad,
                 std::sqrt(path_sigma_[p] * path_sigma_[p] + (inflation_rad2 + by_places * by_places)));
    const double error2 =
        (direction_or_zero(seen) - graph.bearings[p].direction).squaredNorm() / (sigma * sigma);
    const double density =
        params_.direct_probability * path_prior_[p] * direction_density(error2, sigma, azimuth);
    total += density;
    result.path_sigma[p] = sigma;
    result.path_direct[p] = density;
  }
  const bool is_empty = first_path_[b] == first_path_[b + 1];
  result.sight[graph.ranges.size() + b] = {is_empty ? 1 : total, 1};
  if (is_empty) return;
  const auto& first = graph.bearings[first_path_[b]];
  result.log_within_reach[b] = log_within_reach(distance_m(graph, first));
}

template <class Pose>
typename MixtureGraph<Pose>::Densities MixtureGraph<Pose>::densities(const VarianceInflation& inflation,
                                                                     double inflation_scale) const {
  const std::size_t ranges = graph.ranges.size();
  Densities result(ranges, bearing_count(), graph.bearings.size());
  parallel_for(ranges + bearing_count(), kLinksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < std::min(end, ranges); ++k)
      weigh_range(k, added(inflation.ranges_m2, k, inflation_scale), result);
    for (std::size_t k = std::max(begin, ranges); k < end; ++k)
      weigh_bearing(k - ranges, added(inflation.bearings_rad2, k - ranges, inflation_scale), result);
  });
  return result;
}

template <class Pose>
double MixtureGraph<Pose>::log_within_reach(double distance_m) const {
  const double max_range_m = std::max(params_.max_range_m, span_m_);
  const double excess = std::max(0.0, distance_m - max_range_m) / (max_range_m / kReachOverItsSigma);
  return -excess * excess / 2;
}

template <class Pose>
double MixtureGraph<Pose>::other_cost() const {
  double cost = 0;
  const auto add = [&](const auto& factors) {
    using Factor = typename std::decay_t<decltype(factors)>::value_type;
    if constexpr (!std::is_same_v<Factor, RangeFactor<Pose>> &&
                  !std::is_same_v<Factor, BearingFactor<Pose>>) {
      std::vector<double> costs(factors.size());
      parallel_for(factors.size(), kLinksPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          costs[k] = evaluate(loss(factors[k]), weight(factors[k]) * squared_norm(graph, factors[k])).cost;
      });
      cost = std::accumulate(costs.begin(), costs.end(), cost);
    }
  };
  std::apply([&](const auto&... lists) { (add(lists), ...); }, factor_lists(graph));
  return cost;
}

/// Log prior of the obstructed share, a beta density with its mode at the parameter, relative to the mode.
template <class Pose>
double MixtureGraph<Pose>::log_prior(double share) const {
  if (params_.obstructed_share <= 0) return 0;
  const double mode = params_.obstructed_share;
  return kPriorMeasurements *
         (mode * std::log(share / mode) + (1 - mode) * std::log((1 - share) / (1 - mode)));
}

/// Sets the factor of a range.
template <class Pose>
void MixtureGraph<Pose>::set_range(std::size_t k, const Densities& found, double in_sight) {
  auto& range = graph.ranges[k];
  const double sigma = found.range_sigma[k];
  range_weight_[k] = in_sight * found.range_direct[k] / found.sight[k].in_sight;
  range.sigma_m = sigma;
  range.weight = range_weight_[k];
  const double predicted = residual(graph, range)[0] + range.range_m;  // distance and bias
  range.range_m = range_m_[k];
  if (obstructed_share_ <= 0) return;
  const ObstructedRange& detour = found.detours[k];
  const double obstructed = (1 - in_sight) * found.range_longer[k] / found.sight[k].obstructed;
  const double curvature = std::max(detour.curvature, 1 / (span_m_ * span_m_));
  const double pull = obstructed * curvature * sigma * sigma;
  range.weight += pull;
  if (range.weight > 0)
    range.range_m += pull * (predicted - detour.slope / curvature - range_m_[k]) / range.weight;
}

/// Sets the factors of a bearing's paths.
template <class Pose>
void MixtureGraph<Pose>::set_bearing(std::size_t b, const Densities& found, double in_sight) {
  for (std::size_t p = first_path_[b]; p < first_path_[b + 1]; ++p) {
    graph.bearings[p].sigma_rad = found.path_sigma[p];
    graph.bearings[p].weight =
        in_sight * found.path_direct[p] / found.sight[graph.ranges.size() + b].in_sight;
  }
}

template <class Pose>
double MixtureGraph<Pose>::update_weights(const VarianceInflation& inflation, double inflation_scale) {
  const Densities found = densities(inflation, inflation_scale);
  std::vector<double> in_sight;
  const double log_likelihood =
      chains_.smooth(found.sight, obstructed_share_, in_sight) + found.sum_within_reach();
  const std::size_t ranges = graph.ranges.size();
  parallel_for(ranges + bearing_count(), kLinksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < std::min(end, ranges); ++k) set_range(k, found, in_sight[k]);
    for (std::size_t k = std::max(begin, ranges); k < end; ++k) set_bearing(k - ranges, found, in_sight[k]);
  });
  return other_cost() - 2 * (log_likelihood + log_prior(obstructed_share_));
}

template <class Pose>
double MixtureGraph<Pose>::cost(const VarianceInflation& inflation, double inflation_scale) const {
  const Densities found = densities(inflation, inflation_scale);
  return other_cost() - 2 * (chains_.log_likelihood(found.sight, obstructed_share_) +
                             found.sum_within_reach() + log_prior(obstructed_share_));
}

/// Golden section search: links of one exchange, and successive ones, are no independent observations of the
/// share, so that their mean posterior would overstate it.
template <class Pose>
void MixtureGraph<Pose>::estimate_obstructed_share(const VarianceInflation& inflation,
                                                   double inflation_scale) {
  if (params_.obstructed_share <= 0) return;
  const Densities found = densities(inflation, inflation_scale);
  const auto log_posterior = [&](double share) {
    return chains_.log_likelihood(found.sight, share) + log_prior(share);
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = kMinObstructedShare, high = kMaxObstructedShare;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = log_posterior(left), at_right = log_posterior(right);
  while (high - low > kShareTolerance) {
    if (at_left > at_right) {
      high = right, right = left, at_right = at_left;
      left = high - kGolden * (high - low), at_left = log_posterior(left);
    } else {
      low = left, left = right, at_left = at_right;
      right = low + kGolden * (high - low), at_right = log_posterior(right);
    }
  }
  const double best = (low + high) / 2;
  if (log_posterior(best) > log_posterior(obstructed_share_)) obstructed_share_ = best;
}

template <class Pose>
double MixtureGraph<Pose>::direct_weight(std::size_t bearing) const {
  double sum = 0;
  for (std::size_t p = first_path_[bearing]; p < first_path_[bearing + 1]; ++p)
    sum += graph.bearings[p].weight;
  return sum;
}

template std::vector<double> path_priors(const AmbiguousBearing<SE2>&, const MixtureParams&);
template std::vector<double> path_priors(const AmbiguousBearing<SE3>&, const MixtureParams&);
template class MixtureGraph<SE2>;
template class MixtureGraph<SE3>;

}  // namespace radioslam
