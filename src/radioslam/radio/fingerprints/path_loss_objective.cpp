#include "radioslam/radio/fingerprints/path_loss_objective.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "radioslam/radio/fingerprints/censored_loss.hpp"

namespace radioslam {
namespace {

using Eigen::Index;

constexpr double kGrowth = 1.4;  // of cells while there are too many
constexpr double kDecibelsPerNeper = 10 / std::numbers::ln10;

using Cell = std::pair<long, long>;

Cell cell_of(const Eigen::Vector2d& place_m, double cell_m) {
  return {std::lround(std::floor(place_m.x() / cell_m)), std::lround(std::floor(place_m.y() / cell_m))};
}

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

/// One position of each cell without any detection.
Eigen::Matrix2Xd undetected_sites(const RssAlongPath& heard, double cell_m) {
  std::set<Cell> taken;
  for (const PlacedReading& reading : heard.readings) taken.insert(cell_of(reading.place_m, cell_m));
  Eigen::Matrix2Xd sites(2, static_cast<Index>(heard.undetected_m.size()));
  Index count = 0;
  for (const Eigen::Vector2d& place : heard.undetected_m)
    if (taken.insert(cell_of(place, cell_m)).second) sites.col(count++) = place;
  return sites.leftCols(count);
}

Eigen::MatrixXd covariance(const HeardPlaces& places, const AccessPointParams& params) {
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

/// Adds the residual of a site, given its derivatives.
template <int kUnknowns>
void add_heard(PathLossCost<kUnknowns>& sum, double residual,
               const Eigen::Matrix<double, kUnknowns, 1>& derivatives, double loss_sigmas) {
  const double r = std::abs(residual), weight = r <= loss_sigmas ? 1 : loss_sigmas / r;
  sum.heard_cost += r <= loss_sigmas ? r * r : 2 * loss_sigmas * r - loss_sigmas * loss_sigmas;
  sum.gradient += weight * residual * derivatives;
  sum.information += weight * derivatives * derivatives.transpose();
}

/// Adds a censored reading, `z` standard deviations below the threshold.
template <int kUnknowns>
void add_censored(PathLossCost<kUnknowns>& sum, double z,
                  const Eigen::Matrix<double, kUnknowns, 1>& derivatives, double sigma_db) {
  const auto [cost, hazard] = censored_loss(z);
  sum.cost += cost;
  sum.gradient += hazard / sigma_db * derivatives;
  sum.information += hazard * (hazard + z) / (sigma_db * sigma_db) * derivatives * derivatives.transpose();
}

template <int kUnknowns>
void add_prior(PathLossCost<kUnknowns>& sum, int axis, double value, double mean, double sigma) {
  const double off = (value - mean) / sigma;
  sum.cost += off * off;
  sum.gradient[axis] += off / sigma;
  sum.information(axis, axis) += 1 / (sigma * sigma);
}

template <int kUnknowns>
void add_priors(PathLossCost<kUnknowns>& sum, const Eigen::Vector2d& law, const AccessPointParams& params) {
  add_prior(sum, kUnknowns - 2, law[0], params.prior_power_dbm, params.prior_sigma_power_db);
  add_prior(sum, kUnknowns - 1, law[1], params.prior_exponent, params.prior_sigma_exponent);
}

double censored_sigma_db(const AccessPointParams& params) {
  return std::hypot(params.sigma_shadowing_db, params.sigma_fading_db);
}

}  // namespace

HeardPlaces heard_places(const std::vector<PlacedReading>& readings, const AccessPointParams& params) {
  double cell_m = params.cell_m;
  HeardPlaces places = in_cells(readings, cell_m);
  while (places.rss_dbm.size() > params.max_places) places = in_cells(readings, cell_m *= kGrowth);
  return places;
}

PathLossObjective::PathLossObjective(const HeardPlaces& places, const RssAlongPath& heard,
                                     const AccessPointParams& params)
    : params_(params),
      floor_dbm_(heard.floor_dbm),
      heard_m_(places.place_m),
      undetected_m_(undetected_sites(heard, params.undetected_cell_m)),
      noise_(covariance(places, params)),
      ones_(noise_.whitened(Eigen::VectorXd::Ones(places.rss_dbm.size()))),
      rss_(noise_.whitened(places.rss_dbm)) {}

Eigen::VectorXd PathLossObjective::decades(const Eigen::Matrix2Xd& sites_m,
                                           const Eigen::Vector2d& position_m) const {
  const double height2_m2 = params_.height_m * params_.height_m;
  Eigen::VectorXd decades(sites_m.cols());
  for (Index k = 0; k < decades.size(); ++k)
    decades[k] = kDecibelsPerNeper / 2 * std::log((sites_m.col(k) - position_m).squaredNorm() + height2_m2);
  return decades;
}

Eigen::Matrix2Xd PathLossObjective::slopes(const Eigen::Matrix2Xd& sites_m,
                                           const Eigen::Vector2d& position_m) const {
  const double height2_m2 = params_.height_m * params_.height_m;
  Eigen::Matrix2Xd slopes(2, sites_m.cols());
  for (Index k = 0; k < slopes.cols(); ++k) {
    const Eigen::Vector2d away = position_m - sites_m.col(k);
    slopes.col(k) = kDecibelsPerNeper / (away.squaredNorm() + height2_m2) * away;
  }
  return slopes;
}

Eigen::MatrixXd PathLossObjective::heard_decades(const Eigen::Matrix2Xd& positions_m) const {
  Eigen::MatrixXd all(heard_m_.cols(), positions_m.cols());
  for (Index k = 0; k < all.cols(); ++k) all.col(k) = decades(heard_m_, positions_m.col(k));
  return noise_.whitened_matrix(all);
}

Eigen::VectorXd PathLossObjective::undetected_decades(const Eigen::Vector2d& position_m) const {
  return decades(undetected_m_, position_m);
}

Eigen::Vector2d PathLossObjective::fitted_law(const Eigen::VectorXd& heard_decades) const {
  const double cross = -ones_.dot(heard_decades);
  Eigen::Matrix2d information{{ones_.squaredNorm(), cross}, {cross, heard_decades.squaredNorm()}};
  Eigen::Vector2d right(ones_.dot(rss_), -heard_decades.dot(rss_));
  const Eigen::Array2d mean(params_.prior_power_dbm, params_.prior_exponent),
      sigma(params_.prior_sigma_power_db, params_.prior_sigma_exponent);
  information.diagonal().array() += sigma.square().inverse();
  right.array() += mean / sigma.square();
  return ldlt_solve<Eigen::Matrix2d>(information, right);
}

PathLossCost<2> PathLossObjective::heard_at(const Eigen::Vector2d& law,
                                            const Eigen::VectorXd& heard_decades) const {
  PathLossCost<2> sum;
  for (Index k = 0; k < heard_decades.size(); ++k)
    add_heard<2>(sum, law[0] * ones_[k] - law[1] * heard_decades[k] - rss_[k], {ones_[k], -heard_decades[k]},
                 params_.loss_sigmas);
  sum.cost = sum.heard_cost;
  add_priors(sum, law, params_);
  return sum;
}

PathLossCost<2> PathLossObjective::at(const Eigen::Vector2d& law, const Eigen::VectorXd& heard_decades,
                                      const Eigen::VectorXd& undetected_decades) const {
  const double sigma_db = censored_sigma_db(params_);
  PathLossCost<2> sum = heard_at(law, heard_decades);
  for (const double decades : undetected_decades)
    add_censored<2>(sum, (floor_dbm_ - law[0] + law[1] * decades) / sigma_db, {1, -decades}, sigma_db);
  return sum;
}

PathLossCost<4> PathLossObjective::at(const PathLossUnknowns& unknowns) const {
  const Eigen::Vector2d position_m = unknowns.head<2>(), law = unknowns.tail<2>();
  const Eigen::Matrix2Xd heard_slopes = slopes(heard_m_, position_m);
  const Eigen::VectorXd heard = noise_.whitened(decades(heard_m_, position_m)),
                        slope_x = noise_.whitened(heard_slopes.row(0)),
                        slope_y = noise_.whitened(heard_slopes.row(1));
  const double sigma_db = censored_sigma_db(params_);
  PathLossCost<4> sum;
  for (Index k = 0; k < heard.size(); ++k)
    add_heard<4>(sum, law[0] * ones_[k] - law[1] * heard[k] - rss_[k],
                 {-law[1] * slope_x[k], -law[1] * slope_y[k], ones_[k], -heard[k]}, params_.loss_sigmas);
  sum.cost = sum.heard_cost;
  add_priors(sum, law, params_);
  const Eigen::VectorXd undetected = undetected_decades(position_m);
  const Eigen::Matrix2Xd undetected_slopes = slopes(undetected_m_, position_m);
  for (Index k = 0; k < undetected.size(); ++k)
    add_censored<4>(sum, (floor_dbm_ - law[0] + law[1] * undetected[k]) / sigma_db,
                    {-law[1] * undetected_slopes(0, k), -law[1] * undetected_slopes(1, k), 1, -undetected[k]},
                    sigma_db);
  return sum;
}

}  // namespace radioslam
