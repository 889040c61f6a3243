#include "radioslam/radio/fingerprints/access_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "radioslam/geometry/levenberg_marquardt.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kPower_db = 10;

using Eigen::Index;

constexpr double kGrowth = 1.4;  // of cells while there are too many
constexpr double kDecibels = 10;
constexpr std::size_t kStarts = 6;
constexpr LevenbergMarquardtLimits kRefinement{
    .max_steps = 40, .max_damping = 1e8, .settled = 1e-4};  // norm over [m, m, dB, 1]

using Cell = std::pair<long, long>;

Cell cell_of(const Eigen::Vector2d& place_m, double cell_m) {
  return {std::lround(std::floor(place_m.x() / cell_m)), std::lround(std::floor(place_m.y() / cell_m))};
}

/// Sites by column, their mean RSS and number of readings.
struct HeardPlaces {
  Eigen::Matrix2Xd place_m;
  Eigen::VectorXd rss_dbm, readings;
};

HeardPlaces in_cells(const std::vector<PlacedReading>& readings, double cell_m) {
  std::map<Cell, Eigen::Vector4d> cells;  // sums of x, y, RSS and 1
  for (const PlacedReading& reading : readings) {
    auto& sum = cells.try_emplace(cell_of(reading.place_m, cell_m), Eigen::Vector4d::Zero()).first->second;
    sum += Eigen::Vector4d(reading.place_m.x(), reading.place_m.y(), reading.rss_dbm, 1);
  }
  const auto n = static_cast<Index>(cells.size());
  HeardPlaces places{Eigen::Matrix2Xd(2, n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  Index k = 0;
  for (const auto& [cell, sum] : cells) {
    places.place_m.col(k) = sum.head<2>() / sum[3];
    places.rss_dbm[k] = sum[2] / sum[3];
    places.readings[k++] = sum[3];
  }
  return places;
}

HeardPlaces heard_places(const std::vector<PlacedReading>& readings, const AccessPointParams& params) {
  double cell_m = params.cell_m;
  HeardPlaces places = in_cells(readings, cell_m);
  while (places.rss_dbm.size() > params.max_places) places = in_cells(readings, cell_m *= kGrowth);
  return places;
}

/// One position of each cell without any detection.
std::vector<Eigen::Vector2d> undetected_sites(const RssAlongPath& heard, double cell_m) {
  std::set<Cell> taken;
  for (const PlacedReading& reading : heard.readings) taken.insert(cell_of(reading.place_m, cell_m));
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Vector2d& place : heard.undetected_m)
    if (taken.insert(cell_of(place, cell_m)).second) places.push_back(place);
  return places;
}

/// Sites with noise whitened to unit covariance, and sites without detection.
class WhitenedSites {
 public:
  WhitenedSites(const HeardPlaces& places, const RssAlongPath& heard, const AccessPointParams& params)
      : places_(places),
        params_(params),
        noise_(covariance(places, params)),
        undetected_(undetected_sites(heard, params.undetected_cell_m)),
        floor_dbm_(heard.floor_dbm) {
    ones_ = white(Eigen::VectorXd::Ones(places.rss_dbm.size()));
    rss_ = white(places.rss_dbm);
  }

  const Eigen::VectorXd& ones() const { return ones_; }
  const Eigen::VectorXd& rss() const { return rss_; }
  Eigen::VectorXd white(const Eigen::VectorXd& values) const { return noise_.whitened(values); }

  /// 10 log10 d from every site to an access point at `a`.
  Eigen::VectorXd decades(const Eigen::Vector2d& a) const {
    const double height2 = params_.height_m * params_.height_m;
    return kDecibels / 2 *
           ((places_.place_m.colwise() - a).colwise().squaredNorm().transpose().array() + height2).log10();
  }
  /// Derivatives of 10 log10 d over `a`.
  Eigen::MatrixX2d decade_slopes(const Eigen::Vector2d& a) const {
    const double height2 = params_.height_m * params_.height_m;
    const Eigen::Matrix2Xd away = (-places_.place_m).colwise() + a;
    const Eigen::ArrayXd squares = away.colwise().squaredNorm().transpose().array() + height2;
    return (away.transpose().array().colwise() * (kDecibels / std::log(10.0) / squares)).matrix();
  }
  Index size() const { return rss_.size(); }
  const std::vector<Eigen::Vector2d>& undetected() const { return undetected_; }
  double floor_dbm() const { return floor_dbm_; }

 private:
  static Eigen::MatrixXd covariance(const HeardPlaces& places, const AccessPointParams& params) {
    const Index n = places.rss_dbm.size();
    Eigen::MatrixXd c(n, n);
    const double shadowing = params.sigma_shadowing_db * params.sigma_shadowing_db;
    for (Index a = 0; a < n; ++a)
      for (Index b = 0; b <= a; ++b)
        c(a, b) = c(b, a) = shadowing * std::exp(-(places.place_m.col(a) - places.place_m.col(b)).norm() /
                                                 params.shadowing_length_m);
    c.diagonal().array() += params.sigma_fading_db * params.sigma_fading_db / places.readings.array();
    return c;
  }

  const HeardPlaces& places_;
  const AccessPointParams& params_;
  Cholesky<Eigen::MatrixXd> noise_;
  std::vector<Eigen::Vector2d> undetected_;
  double floor_dbm_;
  Eigen::VectorXd ones_, rss_;
};

/// [x, y, P0, n].
using Unknowns = Eigen::Vector4d;

/// Cost (squared residuals under Huber's loss, and the priors'), gradient and information of the unknowns.
struct Objective {
  double cost = 0;
  double heard_cost = 0;  ///< contribution of the residuals
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
};

void add_prior(Objective& sum, const Unknowns& at, int axis, double mean, double sigma) {
  const double off = (at[axis] - mean) / sigma;
  sum.cost += off * off;
  sum.gradient[axis] += off / sigma;
  sum.information(axis, axis) += 1 / (sigma * sigma);
}

/// Hazard of the normal distribution, density over distribution function at z; -z for z far below 0.
double hazard(double z) {
  constexpr double kFarBelow = -12;
  if (z < kFarBelow) return -z;
  const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
  return density / (std::erfc(-z / std::numbers::sqrt2) / 2);
}

/// -2 log Phi(z), continued quadratically where Phi underflows.
double censored_cost(double z) {
  constexpr double kFarBelow = -12;
  if (z < kFarBelow) return z * z + censored_cost(kFarBelow) - kFarBelow * kFarBelow;
  return -2 * std::log(std::erfc(-z / std::numbers::sqrt2) / 2);
}

/// Adds censored readings: at sites without detection the power was below the threshold.
void add_censored(Objective& sum, const Unknowns& at, const WhitenedSites& places,
                  const AccessPointParams& params) {
  const double sigma = std::hypot(params.sigma_shadowing_db, params.sigma_fading_db);
  for (const Eigen::Vector2d& place : places.undetected()) {
    const Eigen::Vector2d away = at.head<2>() - place;
    const double square = away.squaredNorm() + params.height_m * params.height_m;
    const double decades = kDecibels / 2 * std::log10(square);
    const double z = (places.floor_dbm() - (at[2] - at[3] * decades)) / sigma;
    const Eigen::Vector2d slope = -at[3] * kDecibels / std::log(10.0) / square * away;
    const Eigen::Vector4d jacobian(slope.x(), slope.y(), 1, -decades);
    const double pull = hazard(z);
    sum.cost += censored_cost(z);
    sum.gradient += pull / sigma * jacobian;
    sum.information += pull * (pull + z) / (sigma * sigma) * jacobian * jacobian.transpose();
  }
}

/// Objective at these unknowns, given the whitened 10 log10 d and its slopes; slopes of zero hold the
/// position.
Objective objective_of(const Unknowns& at, const Eigen::VectorXd& decades, const Eigen::MatrixX2d& slopes,
                       const WhitenedSites& places, const AccessPointParams& params) {
  Eigen::MatrixX4d jacobian(places.size(), 4);
  jacobian << -at[3] * slopes, places.ones(), -decades;
  const Eigen::VectorXd residual = at[2] * places.ones() - at[3] * decades - places.rss();
  Objective sum;
  Eigen::VectorXd weight(residual.size());
  for (Index k = 0; k < residual.size(); ++k) {
    const double r = std::abs(residual[k]), c = params.loss_sigmas;
    weight[k] = r <= c ? 1 : c / r;
    sum.cost += r <= c ? r * r : 2 * c * r - c * c;
  }
  sum.heard_cost = sum.cost;
  sum.gradient = jacobian.transpose() * weight.cwiseProduct(residual);
  sum.information = jacobian.transpose() * weight.asDiagonal() * jacobian;
  add_censored(sum, at, places, params);
  add_prior(sum, at, 2, params.prior_power_dbm, params.prior_sigma_power_db);
  add_prior(sum, at, 3, params.prior_exponent, params.prior_sigma_exponent);
  return sum;
}

Objective objective_at(const Unknowns& at, const WhitenedSites& places, const AccessPointParams& params) {
  const Eigen::MatrixX2d slopes = places.decade_slopes(at.head<2>());
  Eigen::MatrixX2d white_slopes(slopes.rows(), 2);
  white_slopes << places.white(slopes.col(0)), places.white(slopes.col(1));
  return objective_of(at, places.white(places.decades(at.head<2>())), white_slopes, places, params);
}

/// A candidate position with the P0 and n that fit it best by linear least squares, and their cost.
struct Start {
  Unknowns at;
  double cost = 0;
};

Start start_at(const Eigen::Vector2d& a, const WhitenedSites& places, const AccessPointParams& params) {
  const Eigen::VectorXd decades = places.white(places.decades(a));
  Eigen::MatrixX2d law(places.size() + 2, 2);
  Eigen::VectorXd right(places.size() + 2);
  const Eigen::Vector2d trust(1 / params.prior_sigma_power_db, 1 / params.prior_sigma_exponent);
  law << places.ones(), -decades, trust.asDiagonal().toDenseMatrix();
  right << places.rss(), params.prior_power_dbm * trust[0], params.prior_exponent * trust[1];
  const Eigen::Vector2d fitted = ldlt_solve<Eigen::Matrix2d>(law.transpose() * law, law.transpose() * right);
  const Unknowns at = (Unknowns() << a, fitted).finished();
  const Eigen::MatrixX2d held = Eigen::MatrixX2d::Zero(places.size(), 2);
  return {at, objective_of(at, decades, held, places, params).cost};
}

/// Starts of the refinement, best first: the strongest site, the power-weighted mean, and the points of the
/// grid.
std::vector<Start> starts(const HeardPlaces& heard, const WhitenedSites& places,
                          const AccessPointParams& params) {
  Index strongest = 0;
  heard.rss_dbm.maxCoeff(&strongest);
  const Eigen::VectorXd power =
      ((heard.rss_dbm.array() - heard.rss_dbm[strongest]) / kDecibels).unaryExpr([](double decades) {
        return std::pow(10, decades);
      });
  std::vector<Start> all{start_at(heard.place_m.col(strongest), places, params),
                         start_at(heard.place_m * power / power.sum(), places, params)};
  const Eigen::Vector2d low = heard.place_m.rowwise().minCoeff().array() - params.margin_m;
  const Eigen::Vector2d high = heard.place_m.rowwise().maxCoeff().array() + params.margin_m;
  for (int i = 0; i < params.grid; ++i)
    for (int j = 0; j < params.grid; ++j) {
      const Eigen::Vector2d ratio = Eigen::Vector2d(i, j) / (params.grid - 1);
      all.push_back(start_at(low + ratio.cwiseProduct(high - low), places, params));
    }
  std::stable_sort(all.begin(), all.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; });
  std::vector<Start> apart;
  for (const Start& start : all) {
    const auto near = [&](const Start& other) {
      return (start.at - other.at).head<2>().norm() < params.alternative_distance_m;
    };
    if (apart.size() < kStarts && std::none_of(apart.begin(), apart.end(), near)) apart.push_back(start);
  }
  return apart;
}

using Refined = LocalMinimum<Unknowns, Objective>;

Refined refine(const Unknowns& start, const WhitenedSites& places, const AccessPointParams& params) {
  return levenberg_marquardt(
      start, kRefinement, [&](const Unknowns& at) { return objective_at(at, places, params); },
      [](const Unknowns& at, const Unknowns& move) -> Unknowns { return at + move; });
}

/// Ratio of the residuals' variance to the stated one, with the stated one weighted as `sigma_weight` sites.
double variance_ratio(double cost, Index places, const AccessPointParams& params) {
  return (params.sigma_weight + cost) / (params.sigma_weight + static_cast<double>(places));
}

/// Cost at a fixed position with P0 and n optimized, starting from their values in `from`.
double profile_cost(const Unknowns& from, const Eigen::Vector2d& a, const WhitenedSites& places,
                    const AccessPointParams& params) {
  constexpr int kSteps = 2;
  const Eigen::VectorXd decades = places.white(places.decades(a));
  const Eigen::MatrixX2d held = Eigen::MatrixX2d::Zero(places.size(), 2);
  Unknowns at = from;
  at.head<2>() = a;
  Objective objective = objective_of(at, decades, held, places, params);
  for (int step = 0; step < kSteps; ++step) {
    at.tail<2>() -= ldlt_solve<Eigen::Matrix2d>(objective.information.bottomRightCorner<2, 2>(),
                                                objective.gradient.tail<2>());
    const Objective next = objective_of(at, decades, held, places, params);
    if (!(next.cost < objective.cost)) break;
    objective = next;
  }
  return objective.cost;
}

/// Second moment of the posterior on a grid around the estimate.
Eigen::Matrix2d moment_around(const Refined& best, const WhitenedSites& places, double ratio,
                              const AccessPointParams& params) {
  double sum = 0;
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  const double step_m = 2 * params.around_m / (params.around_places - 1);
  for (int i = 0; i < params.around_places; ++i)
    for (int j = 0; j < params.around_places; ++j) {
      const Eigen::Vector2d off = step_m * Eigen::Vector2d(i, j).array() - params.around_m;
      const double cost = profile_cost(best.at, best.at.head<2>() + off, places, params);
      const double weight = std::exp(std::min(0.0, (best.objective.cost - cost) / (2 * ratio)));
      sum += weight;
      moment += weight * off * off.transpose();
    }
  return moment / sum;
}

/// The covariance, scaled as a whole so that its position part is on average at least `moment`.
Eigen::Matrix4d widened(const Eigen::Matrix4d& covariance, const Eigen::Matrix2d& moment) {
  const Eigen::Matrix2d place = covariance.topLeftCorner<2, 2>();
  const double growth = ldlt_solve_matrix(place, moment).trace() / 2;
  return std::max(1.0, growth) * covariance;
}

AccessPointFit described(const std::vector<Refined>& found, const WhitenedSites& white,
                         const AccessPointParams& params) {
  const Index places = white.size();
  const auto best = std::min_element(found.begin(), found.end(), [](const Refined& a, const Refined& b) {
    return a.objective.cost < b.objective.cost;
  });
  const double ratio = variance_ratio(best->objective.heard_cost, places, params);
  AccessPointFit fit;
  fit.position_m = best->at.head<2>();
  fit.path_loss = {best->at[2], best->at[3]};
  fit.covariance = ratio * ldlt_solve_matrix(best->objective.information, Eigen::Matrix4d::Identity());
  fit.covariance = widened(fit.covariance, moment_around(*best, white, ratio, params));
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
  const WhitenedSites places(means, heard, params);
  std::vector<Refined> found;
  for (const Start& start : starts(means, places, params)) found.push_back(refine(start.at, places, params));
  return described(found, places, params);
}

}  // namespace radioslam
