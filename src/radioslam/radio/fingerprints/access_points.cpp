#include "radioslam/radio/fingerprints/access_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/geometry/levenberg_marquardt.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/fingerprints/path_loss_objective.hpp"

namespace radioslam {
namespace {

constexpr double kPower_db = 10;

using Eigen::Index;

constexpr double kDecibels = 10;
constexpr double kStep_sigmas = 1.5;  // of the sum over the posterior: exact to 0.03 % if it is Gaussian
constexpr Index kBlock = 16;          // positions whose decades are whitened at once
constexpr std::size_t kStarts = 12, kMinima = 4;
constexpr double kSame_m = 1;  // between two minima that are taken for one
constexpr double kCoarse = 2;  // ratio of the cells of the search to those of the estimate
// Settled by the norm over [m, m, dB, 1].
constexpr LevenbergMarquardtLimits kSearch{.max_steps = 40, .max_damping = 1e8, .settled = 0.3};
constexpr LevenbergMarquardtLimits kRefinement{.max_steps = 40, .max_damping = 1e8, .settled = 1e-4};

/// The strongest site, the power-weighted mean, and the points of the grid.
Eigen::Matrix2Xd candidates(const HeardPlaces& heard, const AccessPointParams& params) {
  Index strongest = 0;
  heard.rss_dbm.maxCoeff(&strongest);
  const Eigen::VectorXd power =
      ((heard.rss_dbm.array() - heard.rss_dbm[strongest]) / kDecibels).unaryExpr([](double decades) {
        return std::pow(10, decades);
      });
  const Eigen::Vector2d low = heard.place_m.rowwise().minCoeff().array() - params.margin_m;
  const Eigen::Vector2d high = heard.place_m.rowwise().maxCoeff().array() + params.margin_m;
  Eigen::Matrix2Xd all(2, 2 + params.grid * params.grid);
  all.col(0) = heard.place_m.col(strongest);
  all.col(1) = heard.place_m * power / power.sum();
  for (int i = 0; i < params.grid; ++i)
    for (int j = 0; j < params.grid; ++j) {
      const Eigen::Vector2d ratio = Eigen::Vector2d(i, j) / (params.grid - 1);
      all.col(2 + i * params.grid + j) = low + ratio.cwiseProduct(high - low);
    }
  return all;
}

/// Starts of the search, best first: positions that are apart, with the P0 and n that fit them best by linear
/// least squares.
std::vector<PathLossUnknowns> starts(const HeardPlaces& heard, const PathLossObjective& objective,
                                     const AccessPointParams& params) {
  const Eigen::Matrix2Xd positions = candidates(heard, params);
  std::vector<std::pair<double, PathLossUnknowns>> all;
  for (Index first = 0; first < positions.cols(); first += kBlock) {
    const Index count = std::min(kBlock, positions.cols() - first);
    const Eigen::MatrixXd decades = objective.heard_decades(positions.middleCols(first, count));
    for (Index k = 0; k < count; ++k) {
      const Eigen::Vector2d position_m = positions.col(first + k), law = objective.fitted_law(decades.col(k));
      all.emplace_back(objective.at(law, decades.col(k), objective.undetected_decades(position_m)).cost,
                       (PathLossUnknowns() << position_m, law).finished());
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PathLossUnknowns> apart;
  for (const auto& [cost, start] : all) {
    const auto near = [&, &start = start](const PathLossUnknowns& other) {
      return (start - other).head<2>().norm() < params.alternative_distance_m;
    };
    if (apart.size() < kStarts && std::none_of(apart.begin(), apart.end(), near)) apart.push_back(start);
  }
  return apart;
}

using Refined = LocalMinimum<PathLossUnknowns, PathLossCost<4>>;

bool costs_less(const Refined& a, const Refined& b) { return a.objective.cost < b.objective.cost; }

Refined refine(const PathLossUnknowns& start, const PathLossObjective& objective,
               const LevenbergMarquardtLimits& limits) {
  return levenberg_marquardt(
      start, limits, [&](const PathLossUnknowns& at) { return objective.at(at); },
      [](const PathLossUnknowns& at, const PathLossUnknowns& move) -> PathLossUnknowns { return at + move; });
}

/// The best minima of the objective over coarser cells: starts for that over the cells asked for.
std::vector<Refined> search(const RssAlongPath& heard, AccessPointParams params) {
  params.cell_m *= kCoarse;
  params.undetected_cell_m *= kCoarse;
  const HeardPlaces places = heard_places(heard.readings, params);
  const PathLossObjective objective(places, heard, params);
  std::vector<Refined> minima;
  for (const PathLossUnknowns& start : starts(places, objective, params)) {
    const Refined minimum = refine(start, objective, kSearch);
    const auto same = [&](const Refined& other) {
      return (minimum.at - other.at).head<2>().norm() < kSame_m;
    };
    if (std::none_of(minima.begin(), minima.end(), same)) minima.push_back(minimum);
  }
  std::stable_sort(minima.begin(), minima.end(), costs_less);
  minima.resize(std::min(minima.size(), kMinima));
  return minima;
}

/// Ratio of the residuals' variance to the stated one, with the stated one weighted as `sigma_weight` sites.
double variance_ratio(double cost, Index places, const AccessPointParams& params) {
  return (params.sigma_weight + cost) / (params.sigma_weight + static_cast<double>(places));
}

/// Cost at a fixed position with P0 and n optimized, starting from and replacing those of `law`.
double profile_cost(Eigen::Vector2d& law, const Eigen::VectorXd& heard_decades,
                    const Eigen::VectorXd& undetected_decades, const PathLossObjective& objective) {
  constexpr int kSteps = 3;
  constexpr double kSmall = 0.1;  // promised decrease that a step keeps
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kSteps; ++step) {
    const PathLossCost<2> cost = objective.at(law, heard_decades, undetected_decades);
    const Eigen::Vector2d move = ldlt_solve<Eigen::Matrix2d>(cost.information, cost.gradient);
    const double decrease = move.dot(cost.gradient);
    if (!(cost.cost < least)) break;
    least = cost.cost - (decrease < kSmall ? decrease : 0);
    law -= move;
    if (decrease < kSmall) break;
  }
  return least;
}

/// Second moment of the posterior on a grid around the estimate, whose step is as fine as the posterior.
Eigen::Matrix2d moment_around(const Refined& best, const PathLossObjective& objective, double sigma_m,
                              double ratio, const AccessPointParams& params) {
  const double width_m = 2 * params.around_m * params.around_places / (params.around_places - 1);
  const double enough = std::ceil(width_m / (kStep_sigmas * sigma_m));
  const int n = enough < params.around_places ? static_cast<int>(enough) | 1 : params.around_places;
  double sum = 0;
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  Eigen::Vector2d law = best.at.tail<2>();
  Eigen::Matrix2Xd offsets(2, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      offsets.col(j) = (Eigen::Array2d(i, i % 2 == 0 ? j : n - 1 - j) - (n - 1) / 2.0) * (width_m / n);
    const Eigen::Matrix2Xd positions = offsets.colwise() + best.at.head<2>();
    const Eigen::MatrixXd decades = objective.heard_decades(positions);
    for (int j = 0; j < n; ++j) {
      const double cost =
          profile_cost(law, decades.col(j), objective.undetected_decades(positions.col(j)), objective);
      const double weight = std::exp(std::min(0.0, (best.objective.cost - cost) / (2 * ratio)));
      sum += weight;
      moment += weight * offsets.col(j) * offsets.col(j).transpose();
    }
  }
  return moment / sum;
}

/// The covariance, scaled as a whole so that its position part is on average at least `moment`.
Eigen::Matrix4d widened(const Eigen::Matrix4d& covariance, const Eigen::Matrix2d& moment) {
  const Eigen::Matrix2d place = covariance.topLeftCorner<2, 2>();
  const double growth = ldlt_solve_matrix(place, moment).trace() / 2;
  return std::max(1.0, growth) * covariance;
}

AccessPointFit described(const std::vector<Refined>& found, const PathLossObjective& objective,
                         const AccessPointParams& params) {
  const Index places = objective.places();
  const auto best = std::min_element(found.begin(), found.end(), costs_less);
  const double ratio = variance_ratio(best->objective.heard_cost, places, params);
  AccessPointFit fit;
  fit.position_m = best->at.head<2>();
  fit.path_loss = {best->at[2], best->at[3]};
  fit.covariance = ratio * ldlt_solve_matrix(best->objective.information, Eigen::Matrix4d::Identity());
  const Eigen::Matrix2d local = fit.covariance.topLeftCorner<2, 2>();
  const double sigma_m = std::sqrt(std::max(0.0, symmetric_eigenvalues<Eigen::Matrix2d>(local)[0]));
  fit.covariance = widened(fit.covariance, moment_around(*best, objective, sigma_m, ratio, params));
  fit.sigma_db = std::sqrt(ratio) * std::hypot(params.sigma_shadowing_db, params.sigma_fading_db);
  fit.places = static_cast<std::size_t>(places);
  double alternative_cost = best->objective.cost + ratio * params.alternative_margin;
  for (const Refined& other : found)
    if ((other.at - best->at).head<2>().norm() > params.alternative_distance_m &&
        other.objective.cost < alternative_cost) {
      alternative_cost = other.objective.cost;
      fit.alternative_m = other.at.head<2>();
    }
  const Eigen::Vector2d variances =
      symmetric_eigenvalues<Eigen::Matrix2d>(fit.covariance.topLeftCorner<2, 2>());
  const bool certain =
      fit.covariance.allFinite() && variances[0] > 0 && std::sqrt(variances[1]) <= params.max_sigma_m;
  if (!certain)
    fit.status = AccessPointStatus::kPoorlyConstrained;
  else if (fit.alternative_m)
    fit.status = AccessPointStatus::kAmbiguous;
  return fit;
}

}  // namespace

double PathLoss::power_dbm(double distance_m) const {
  return power_at_1m_dbm - kPower_db * exponent * std::log10(distance_m);
}

double PathLoss::distance_m(double power_dbm) const {
  return std::pow(10, (power_at_1m_dbm - power_dbm) / (kPower_db * exponent));
}

std::optional<AccessPointFit> fit_access_point(const RssAlongPath& heard, const AccessPointParams& params) {
  const HeardPlaces means = heard_places(heard.readings, params);
  if (means.rss_dbm.size() < params.min_places) return std::nullopt;
  const PathLossObjective objective(means, heard, params);
  std::vector<Refined> found;
  for (const Refined& start : search(heard, params))
    found.push_back(refine(start.at, objective, kRefinement));
  return described(found, objective, params);
}

}  // namespace radioslam
