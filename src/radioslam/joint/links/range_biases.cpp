#include "radioslam/joint/links/range_biases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {
namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sum over all sequences of (e_t - mean) (e_{t + lag} - mean).
double lagged_products(const std::vector<std::vector<double>>& sequences, std::size_t lag) {
  double sum = 0;
  for (const auto& e : sequences) {
    const double mean = e.empty() ? 0 : mean_of(e);
    for (std::size_t t = 0; t + lag < e.size(); ++t) sum += (e[t] - mean) * (e[t + lag] - mean);
  }
  return sum;
}

}  // namespace

double middle_of_shortest_half(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  double shortest = std::numeric_limits<double>::infinity(), middle = 0;
  for (std::size_t k = 0; k + half < values.size(); ++k) {
    const double length = values[k + half] - values[k];
    if (length >= shortest) continue;
    shortest = length;
    middle = (values[k + half] + values[k]) / 2;
  }
  return middle;
}

double correlation_time(const std::vector<std::vector<double>>& sequences) {
  const double variance = lagged_products(sequences, 0);
  std::size_t longest = 0;
  for (const auto& e : sequences) longest = std::max(longest, e.size());
  double time = 1;
  for (std::size_t lag = 1; lag < longest; ++lag) {
    const double product = lagged_products(sequences, lag);
    if (!(product > 0)) break;
    time += 2 * product / variance;
  }
  return time;
}

std::optional<BiasDistribution> bias_distribution(const std::vector<double>& biases_m,
                                                  const Eigen::MatrixXd& covariance,
                                                  double false_alarm_probability, double min_spread_m) {
  const Eigen::Map<const Eigen::VectorXd> b(biases_m.data(), covariance.rows());
  const auto n = static_cast<int>(b.size());
  if (b.dot(Cholesky<Eigen::MatrixXd>(covariance).solve(b)) <=
      chi_squared_quantile(1 - false_alarm_probability, n))
    return std::nullopt;
  const Eigen::ArrayXd w = covariance.diagonal().array().inverse();
  const double mean = (w * b.array()).sum() / w.sum();
  const double freedom = w.sum() - w.square().sum() / w.sum();
  const double spread2 = freedom > 0 ? ((w * (b.array() - mean).square()).sum() - (n - 1)) / freedom : 0;
  return BiasDistribution{mean, std::sqrt(std::max(spread2, std::pow(min_spread_m, 2)))};
}

namespace {

constexpr double kProbablyDirect = 0.5;
constexpr double kMaxBiasSigmas = 3;  // a larger error is a detour, even where most ranges of a pair have one
constexpr double kConvergedWeightChange =
    0.01;  // largest change of a weight at which the rounds have converged

template <class Pose>
class BiasEstimation {
 public:
  BiasEstimation(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                 const RangeBiasPriorParams& params, const MixtureParams& mixture,
                 const OptimizerParams& optimizer, const Progress& progress)
      : joint_(joint),
        alignment_(alignment),
        graph_(joint.team.graph),
        params_(params),
        mixture_(mixture),
        optimizer_(optimizer),
        progress_(progress),
        radio_ranges_(factors_of(joint.origins.ranges, FactorSource::kRange)) {}

  std::vector<RangeBiasResult> run() {
    const JointGraph<Pose> before = joint_;
    add_biases();
    if (graph_.range_biases.empty()) return {};
    optimize_in_turn();
    if (const auto population = this->population()) {
      set_hyperprior(*population);
      optimize_in_turn();
      return described();
    }
    joint_ = before;
    return {};
  }

 private:
  std::size_t pair_of(std::size_t range) const { return joint_.origins.ranges[range].antenna_pair; }

  void add_biases() {
    std::vector<std::vector<double>> residuals_m(joint_.antenna_pairs.size());
    for (const std::size_t k : radio_ranges_) {
      const double excess_m = -residual(graph_, graph_.ranges[k])[0];
      const double sigma_m = std::hypot(params_.prior_sigma_m, graph_.ranges[k].sigma_m);
      if (std::abs(excess_m) < kMaxBiasSigmas * sigma_m) residuals_m[pair_of(k)].push_back(excess_m);
    }
    bias_of_pair_.assign(residuals_m.size(), BiasId());
    for (std::size_t pair = 0; pair < residuals_m.size(); ++pair) {
      if (residuals_m[pair].size() < static_cast<std::size_t>(params_.min_ranges)) continue;
      bias_of_pair_[pair] = BiasId(graph_.range_biases.size());
      graph_.range_bias_priors.push_back({bias_of_pair_[pair], {}, 0, params_.prior_sigma_m});
      graph_.range_biases.push_back(middle_of_shortest_half(std::move(residuals_m[pair])));
    }
    for (const std::size_t k : radio_ranges_) graph_.ranges[k].bias = bias_of_pair_[pair_of(k)];
  }

  /// Updates the weights of all links; returns the largest change of a range with a bias.
  double update_weights() {
    const std::vector<RangeFactor<Pose>> before = graph_.ranges;
    reweigh_radio_links(joint_, alignment_, mixture_);
    double change = 0;
    for (const std::size_t k : radio_ranges_)
      if (graph_.ranges[k].bias.valid())
        change = std::max(change, std::abs(graph_.ranges[k].weight - before[k].weight));
    return change;
  }

  void optimize_in_turn() {
    for (int round = 0; round < params_.max_rounds; ++round) {
      const bool converged = update_weights() < kConvergedWeightChange;
      optimize(graph_, optimizer_, progress_);
      if (converged) return;
    }
  }

  /// Factor on the covariance for errors larger than stated or correlated: the residuals' normalised mean
  /// square, at least 1, times the correlation time within each pair's sequence.
  double overdispersion() const {
    std::vector<std::vector<double>> errors(joint_.antenna_pairs.size());
    double sum = 0, weights = 0;
    for (const std::size_t k : radio_ranges_) {
      const RangeFactor<Pose>& range = graph_.ranges[k];
      sum += range.weight * squared_norm(graph_, range);
      weights += range.weight;
      if (range.weight > kProbablyDirect)
        errors[pair_of(k)].push_back(residual(graph_, range)[0] / range.sigma_m);
    }
    return std::max(1.0, sum / std::max(weights, 1.0)) * correlation_time(errors);
  }

  /// Joint covariance of all biases; nothing if singular.
  std::optional<Eigen::MatrixXd> covariance() const {
    const auto marginals = Marginals<Pose>::compute(graph_for_covariances(joint_, mixture_).team.graph);
    if (!marginals) return std::nullopt;
    const auto n = static_cast<Eigen::Index>(graph_.range_biases.size());
    Eigen::MatrixXd result(n, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      const BiasId bias_a(static_cast<std::size_t>(a));
      result(a, a) = marginals->range_bias_m2(bias_a);
      for (Eigen::Index b = 0; b < a; ++b)
        result(a, b) = result(b, a) =
            marginals->joint(variable(bias_a), variable(BiasId(static_cast<std::size_t>(b))))(0, 1);
    }
    return Eigen::MatrixXd(overdispersion() * result);
  }

  /// Distribution of the biases; nothing if they are not significant or not observable.
  std::optional<BiasDistribution> population() const {
    const auto cov = covariance();
    if (!cov) return std::nullopt;
    return bias_distribution(graph_.range_biases, *cov, params_.false_alarm_probability,
                             params_.min_spread_m);
  }

  void set_hyperprior(const BiasDistribution& population) {
    const BiasId mean(graph_.range_biases.size());
    for (auto& prior : graph_.range_bias_priors) prior.of = mean, prior.sigma_m = population.sigma_m;
    graph_.range_bias_priors.push_back({mean, {}, 0, params_.prior_sigma_m});
    graph_.range_biases.push_back(population.mean_m);
  }

  std::vector<RangeBiasResult> described() const {
    const auto cov = covariance();
    std::vector<RangeBiasResult> results;
    for (std::size_t pair = 0; cov && pair < bias_of_pair_.size(); ++pair) {
      if (!bias_of_pair_[pair].valid()) continue;
      const std::size_t bias = bias_of_pair_[pair].index();
      const auto [end_i, end_j] = joint_.antenna_pairs[pair];
      std::size_t ranges = 0;
      for (const std::size_t k : radio_ranges_) ranges += pair_of(k) == pair ? 1U : 0U;
      const auto row = static_cast<Eigen::Index>(bias);
      results.push_back({end_i, end_j, graph_.range_biases[bias], std::sqrt((*cov)(row, row)), ranges});
    }
    return results;
  }

  JointGraph<Pose>& joint_;
  const TeamAlignment<Pose>& alignment_;
  PoseGraph<Pose>& graph_;
  const RangeBiasPriorParams& params_;
  const MixtureParams& mixture_;
  const OptimizerParams& optimizer_;
  const Progress& progress_;
  std::vector<std::size_t> radio_ranges_;
  std::vector<BiasId> bias_of_pair_;
};

}  // namespace

template <class Pose>
std::vector<RangeBiasResult> estimate_range_biases(
    JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment, const RangeBiasPriorParams& params,
    const MixtureParams& mixture, const OptimizerParams& optimizer, const Progress& progress) {
  if (params.prior_sigma_m <= 0 || alignment.segments.of_segment.empty()) return {};
  return BiasEstimation<Pose>(joint, alignment, params, mixture, optimizer, progress).run();
}

#define RADIOSLAM_RANGE_BIASES(Pose)                                                                    \
  template std::vector<RangeBiasResult> estimate_range_biases(                                          \
      JointGraph<Pose>&, const TeamAlignment<Pose>&, const RangeBiasPriorParams&, const MixtureParams&, \
      const OptimizerParams&, const Progress&);
RADIOSLAM_RANGE_BIASES(SE2)
RADIOSLAM_RANGE_BIASES(SE3)
#undef RADIOSLAM_RANGE_BIASES

}  // namespace radioslam
