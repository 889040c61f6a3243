#include "radioslam/team_frame/measurement_mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/loss.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kReachOverItsSigma = 4;

double added(const std::vector<double>& inflation, std::size_t k, double inflation_scale) {
  return inflation.empty() ? 0 : inflation_scale * inflation[k];
}

double normal_density(double squared_norm, double sigma) {
  return std::exp(-0.5 * squared_norm) / (std::sqrt(2 * kPi) * sigma);
}

/// Density of a direction relative to the uniform density, of azimuths or over the sphere.
double direction_density(double squared_norm, double sigma, bool azimuth_only) {
  const double peak = azimuth_only ? std::sqrt(2 * kPi) / sigma : 2 / (sigma * sigma);
  return peak * std::exp(-0.5 * squared_norm);
}

template <class Pose>
bool is_azimuth(const BearingFactor<Pose>& factor) {
  return Pose::kDim == 2 || factor.azimuth_only;
}

/// Densities of the direct and the outlier term.
std::array<double, 2> range_densities(double error_m, double sigma_m, double span_m,
                                      const MixtureParams& params) {
  const double error = error_m / sigma_m;
  return {(1 - params.false_range_probability) * normal_density(error * error, sigma_m),
          params.false_range_probability / span_m};
}

}  // namespace

double range_posterior(double error_m, double sigma_m, double span_m, const MixtureParams& params) {
  const auto [direct, wrong] = range_densities(error_m, sigma_m, span_m, params);
  return direct / (direct + wrong);
}

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

template <class Pose>
MixtureGraph<Pose>::MixtureGraph(const TeamGraph<Pose>& team, const MixtureParams& params)
    : graph(team.graph), params_(params) {
  for (const auto& range : graph.ranges) {
    range_sigma_.push_back(range.sigma_m);
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
}

template <class Pose>
template <class Visit>
double MixtureGraph<Pose>::visit_measurements(const VarianceInflation& inflation, double inflation_scale,
                                              Visit&& visit) const {
  double log_likelihood = 0;
  for (std::size_t k = 0; k < graph.ranges.size(); ++k) {
    const double sigma =
        std::sqrt(range_sigma_[k] * range_sigma_[k] + added(inflation.ranges_m2, k, inflation_scale));
    const auto [direct, wrong] =
        range_densities(residual(graph, graph.ranges[k])[0], sigma, span_m_, params_);
    log_likelihood += std::log(direct + wrong);
    visit.range(k, sigma, direct / (direct + wrong));
  }
  for (std::size_t b = 0; b + 1 < first_path_.size(); ++b) {
    const std::size_t begin = first_path_[b], end = first_path_[b + 1];
    if (begin == end) continue;
    const double distance = distance_m(graph, graph.bearings[begin].i, graph.bearings[begin].j);
    const double inflated = added(inflation.bearings_rad2, b, inflation_scale);
    double total = 1 - params_.direct_probability;
    visit.begin_bearing();
    for (std::size_t p = begin; p < end; ++p) {
      const bool azimuth = is_azimuth(graph.bearings[p]);
      const typename Pose::Point seen = seen_by_receiver(graph, graph.bearings[p]);
      const double by_places = params_.sigma_antenna_position_m / std::max(seen.norm(), kMinimumDistance_m);
      const double sigma =
          std::min(azimuth ? kWidestAzimuth_rad : kWidestDirection_rad,
                   std::sqrt(path_sigma_[p] * path_sigma_[p] + (inflated + by_places * by_places)));
      const double error2 =
          (direction_or_zero(seen) - graph.bearings[p].direction).squaredNorm() / (sigma * sigma);
      const double density =
          params_.direct_probability * path_prior_[p] * direction_density(error2, sigma, azimuth);
      total += density;
      visit.path(p, sigma, density);
    }
    visit.end_bearing(begin, end, total);
    log_likelihood += std::log(total) + log_within_reach(distance);
  }
  return log_likelihood;
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
  for_each_factor(graph, [&](const auto& factor) {
    using Factor = std::decay_t<decltype(factor)>;
    if constexpr (!std::is_same_v<Factor, RangeFactor<Pose>> && !std::is_same_v<Factor, BearingFactor<Pose>>)
      cost += evaluate(loss(factor), weight(factor) * squared_norm(graph, factor)).cost;
  });
  return cost;
}

template <class Pose>
double MixtureGraph<Pose>::update_weights(const VarianceInflation& inflation, double inflation_scale) {
  struct Set {
    PoseGraph<Pose>& graph;
    void range(std::size_t k, double sigma, double posterior) {
      graph.ranges[k].sigma_m = sigma;
      graph.ranges[k].weight = posterior;
    }
    void begin_bearing() {}
    void path(std::size_t p, double sigma, double density) {
      graph.bearings[p].sigma_rad = sigma;
      graph.bearings[p].weight = density;
    }
    void end_bearing(std::size_t begin, std::size_t end, double total) {
      for (std::size_t p = begin; p < end; ++p) graph.bearings[p].weight /= total;
    }
  };
  const double log_likelihood = visit_measurements(inflation, inflation_scale, Set{graph});
  return other_cost() - 2 * log_likelihood;
}

template <class Pose>
double MixtureGraph<Pose>::cost(const VarianceInflation& inflation, double inflation_scale) const {
  struct Ignore {
    void range(std::size_t, double, double) {}
    void begin_bearing() {}
    void path(std::size_t, double, double) {}
    void end_bearing(std::size_t, std::size_t, double) {}
  };
  return other_cost() - 2 * visit_measurements(inflation, inflation_scale, Ignore{});
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
