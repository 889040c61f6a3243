#include "radioslam/pipeline/range_biases.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/team_frame/observed_information.hpp"

namespace radioslam {
namespace {

constexpr double kProbablyDirect = 0.5;
constexpr double kSettledWeight = 0.01;  // a largest change of the weights below which rounds end

/// The middle of the shortest interval that holds half of the values.
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

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sum over the sequences of (e_t - mean) (e_{t + lag} - mean).
double lagged_products(const std::vector<std::vector<double>>& sequences, std::size_t lag) {
  double sum = 0;
  for (const auto& e : sequences) {
    const double mean = e.empty() ? 0 : mean_of(e);
    for (std::size_t t = 0; t + lag < e.size(); ++t) sum += (e[t] - mean) * (e[t + lag] - mean);
  }
  return sum;
}

/// 1 + 2 sum of the autocorrelations, over lags up to the first that is not positive (Geyer 1992): how many
/// of a sequence's values count as one.
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

template <class Pose>
class BiasEstimation {
 public:
  BiasEstimation(JointGraph<Pose>& joint, const TeamBiasParams& params, const MixtureParams& mixture,
                 const OptimizerParams& optimizer, const Progress& progress)
      : joint_(joint),
        graph_(joint.team.graph),
        params_(params),
        mixture_(mixture),
        optimizer_(optimizer),
        progress_(progress) {
    for (std::size_t k = 0; k < joint_.range_pairs.size(); ++k)
      span_m_ = std::max(span_m_, graph_.ranges[k].range_m);
  }

  std::vector<RangeBiasResult> run() {
    const PoseGraph<Pose> before = graph_;
    add_biases();
    if (graph_.range_biases.empty()) return {};
    settle();
    if (const auto population = this->population()) {
      take_from(*population);
      settle();
      return described();
    }
    graph_ = before;
    return {};
  }

 private:
  void add_biases() {
    std::vector<std::vector<double>> residuals_m(joint_.antenna_pairs.size());
    for (std::size_t k = 0; k < joint_.range_pairs.size(); ++k)
      residuals_m[joint_.range_pairs[k]].push_back(-residual(graph_, graph_.ranges[k])[0]);
    bias_of_pair_.assign(residuals_m.size(), BiasId());
    for (std::size_t pair = 0; pair < residuals_m.size(); ++pair) {
      if (residuals_m[pair].size() < static_cast<std::size_t>(params_.least_ranges)) continue;
      bias_of_pair_[pair] = BiasId(graph_.range_biases.size());
      graph_.range_bias_priors.push_back({bias_of_pair_[pair], {}, 0, params_.prior_sigma_m});
      graph_.range_biases.push_back(middle_of_shortest_half(std::move(residuals_m[pair])));
    }
    for (std::size_t k = 0; k < joint_.range_pairs.size(); ++k)
      graph_.ranges[k].bias = bias_of_pair_[joint_.range_pairs[k]];
  }

  /// Of the ranges with a bias; returns the largest change.
  double reweigh() {
    double change = 0;
    for (std::size_t k = 0; k < joint_.range_pairs.size(); ++k) {
      RangeFactor<Pose>& range = graph_.ranges[k];
      if (!range.bias.valid()) continue;
      const double weight = range_posterior(residual(graph_, range)[0], range.sigma_m, span_m_, mixture_);
      change = std::max(change, std::abs(weight - range.weight));
      range.weight = weight;
    }
    return change;
  }

  void settle() {
    for (int round = 0; round < params_.most_rounds; ++round) {
      const bool settled = reweigh() < kSettledWeight;
      optimize(graph_, optimizer_, progress_);
      if (settled) return;
    }
  }

  /// By how much the ranges say less than as many independent ones with the stated noise: their residuals'
  /// mean square, at least 1, times the correlation time of each pair's sequence.
  double overdispersion() const {
    std::vector<std::vector<double>> errors(joint_.antenna_pairs.size());
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < joint_.range_pairs.size(); ++k) {
      const RangeFactor<Pose>& range = graph_.ranges[k];
      sum += range.weight * squared_norm(graph_, range);
      weights += range.weight;
      if (range.weight > kProbablyDirect)
        errors[joint_.range_pairs[k]].push_back(residual(graph_, range)[0] / range.sigma_m);
    }
    return std::max(1.0, sum / std::max(weights, 1.0)) * correlation_time(errors);
  }

  /// Of all biases together; nothing where it is singular.
  std::optional<Eigen::MatrixXd> covariance() const {
    PoseGraph<Pose> honest = graph_;
    discount_uncertain_measurements(honest, joint_.first_closure_range, mixture_.sigma_place_m);
    const auto marginals = Marginals<Pose>::compute(honest);
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

  struct Population {
    double mean_m, sigma_m;
  };

  /// Where the biases come from, if they show at all. Each counts by its own variance v only: what the
  /// covariances between them promise rests on ranges without common errors. For b ~ N(m, v + s^2) and w = 1
  /// / v (DerSimonian and Laird 1986): m = sum w b / sum w, s^2 from E sum w (b - m)^2 = n - 1 + s^2 (sum w -
  /// sum w^2 / sum w).
  std::optional<Population> population() const {
    const auto cov = covariance();
    if (!cov) return std::nullopt;
    const Eigen::Map<const Eigen::VectorXd> b(graph_.range_biases.data(), cov->rows());
    const auto n = static_cast<int>(b.size());
    if (b.dot(cov->llt().solve(b)) <= chi_squared_quantile(1 - params_.false_alarm_probability, n))
      return std::nullopt;
    const Eigen::ArrayXd w = cov->diagonal().array().inverse();
    const double mean = (w * b.array()).sum() / w.sum();
    const double freedom = w.sum() - w.square().sum() / w.sum();
    const double spread2 = freedom > 0 ? ((w * (b.array() - mean).square()).sum() - (n - 1)) / freedom : 0;
    return Population{mean, std::sqrt(std::max(spread2, std::pow(params_.least_spread_m, 2)))};
  }

  void take_from(const Population& population) {
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
      const auto ranges = std::count(joint_.range_pairs.begin(), joint_.range_pairs.end(), pair);
      const auto row = static_cast<Eigen::Index>(bias);
      results.push_back({end_i, end_j, graph_.range_biases[bias], std::sqrt((*cov)(row, row)),
                         static_cast<std::size_t>(ranges)});
    }
    return results;
  }

  JointGraph<Pose>& joint_;
  PoseGraph<Pose>& graph_;
  const TeamBiasParams& params_;
  const MixtureParams& mixture_;
  const OptimizerParams& optimizer_;
  const Progress& progress_;
  double span_m_ = 1;
  std::vector<BiasId> bias_of_pair_;
};

}  // namespace

template <class Pose>
std::vector<RangeBiasResult> estimate_range_biases(JointGraph<Pose>& joint, const TeamBiasParams& params,
                                                   const MixtureParams& mixture,
                                                   const OptimizerParams& optimizer,
                                                   const Progress& progress) {
  if (params.prior_sigma_m <= 0) return {};
  return BiasEstimation<Pose>(joint, params, mixture, optimizer, progress).run();
}

template std::vector<RangeBiasResult> estimate_range_biases(JointGraph<SE2>&, const TeamBiasParams&,
                                                            const MixtureParams&, const OptimizerParams&,
                                                            const Progress&);
template std::vector<RangeBiasResult> estimate_range_biases(JointGraph<SE3>&, const TeamBiasParams&,
                                                            const MixtureParams&, const OptimizerParams&,
                                                            const Progress&);

}  // namespace radioslam
