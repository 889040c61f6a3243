// Access point localisation: position and path loss of an access point from RSS along known trajectories.
//
//   P(p) = P0 - 10 n log10 d(p) + s(p) + e,  d(p)^2 = |p - a|^2 + height^2
// for a receiver at p and the access point at a, both in the plane, with shadowing s correlated over
// `shadowing_length_m` (Gudmundson 1991: exp(-distance / length)) and fading e. Readings are averaged per
// cell (site), and the sites' noise is whitened by its Cholesky factor. P0 and n have Gaussian priors and are
// linear given a: a is searched on a grid over and around the paths, and the best grid points are refined
// over all four unknowns by Levenberg-Marquardt with Huber's loss, first over coarser cells; the best minima
// are refined over the cells asked for. Sites that did not detect the access point are censored readings (a
// Tobit term -2 log Phi per cell); without them, distant sites that happened to detect it would bias n. The
// covariance is the inverse information or, if larger, the posterior's second moment around the estimate. As
// a straight path cannot resolve its two sides, a second position that fits nearly as well is reported as the
// alternative. Metres and dBm. Cost: cube of the number of sites (at most `max_places`), and its square per
// position tried, some 300; 4 ms for a hundred sites.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Log-distance path loss of one transmitter: P(d) = P0 - 10 n log10(d / d0) + N(0, sigma^2), d0 = 1 m.
struct PathLoss {
  double power_at_1m_dbm = -40;  ///< P0
  double exponent = 3;           ///< n

  double power_dbm(double distance_m) const;
  /// Distance at which this power is expected.
  double distance_m(double power_dbm) const;
};

struct AccessPointParams {
  int min_places = 8;
  double cell_m = 2;
  int max_places = 250;
  double height_m = 2;
  double prior_exponent = 3;  ///< n
  double prior_sigma_exponent = 0.5;
  double prior_power_dbm = -40;  ///< P0
  double prior_sigma_power_db = 8;
  double sigma_shadowing_db = 5;
  double shadowing_length_m = 6;
  double sigma_fading_db = 2;
  double sigma_weight = 200;
  double loss_sigmas = 2;
  double undetected_cell_m = 8;
  double around_m = 12;
  int around_places = 17;
  double margin_m = 40;
  int grid = 16;
  double alternative_distance_m = 10;
  double alternative_margin = 6;
  double max_sigma_m = 20;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        min_places, "", 4, 1e6,
        "smallest number of sites that detected the access point; with fewer it is not localised");
    RADIOSLAM_FIELD(cell_m, "m", 0.01, 1000,
                    "size of the cells within which readings are averaged into one site");
    RADIOSLAM_FIELD(
        max_places, "", 10, 10000,
        "largest number of sites; cells grow until there are no more; computing time grows with its cube");
    RADIOSLAM_FIELD(height_m, "m", 0.1, 100, "height of access points above the receivers");
    RADIOSLAM_BASIC_FIELD(prior_exponent, "", 1, 8,
                          "prior mean of the path loss exponent: 2 in free space, up to 4 through walls");
    RADIOSLAM_FIELD(prior_sigma_exponent, "", 1e-3, 10, "prior standard deviation of the path loss exponent");
    RADIOSLAM_FIELD(prior_power_dbm, "dBm", -200, 100,
                    "prior mean of the received power at 1 m: 20 dBm minus 40 dB at 2.4 GHz, minus losses");
    RADIOSLAM_FIELD(prior_sigma_power_db, "dB", 1e-3, 100,
                    "prior standard deviation of the received power at 1 m");
    RADIOSLAM_FIELD(sigma_shadowing_db, "dB", 0.01, 100,
                    "standard deviation of shadowing; 3 to 8 dB in the literature");
    RADIOSLAM_FIELD(shadowing_length_m, "m", 0.01, 1000,
                    "correlation length of shadowing; a few metres indoors");
    RADIOSLAM_FIELD(sigma_fading_db, "dB", 0.01, 100, "standard deviation of the fading of one reading");
    RADIOSLAM_FIELD(sigma_weight, "", 0.1, 1e6,
                    "number of sites that the stated shadowing and fading count as; higher values rely less "
                    "on the residuals");
    RADIOSLAM_FIELD(loss_sigmas, "", 0.1, 1e6, "scale of Huber's loss, in standard deviations");
    RADIOSLAM_FIELD(undetected_cell_m, "m", 0.1, 1000,
                    "size of the cells within which sites without detection count as one");
    RADIOSLAM_FIELD(around_m, "m", 0.1, 1000,
                    "half-width of the square around the estimate over which the posterior is summed");
    RADIOSLAM_FIELD(around_places, "", 3, 1000,
                    "number of points along each side of the square over which the posterior is summed");
    RADIOSLAM_FIELD(margin_m, "m", 0, 1e5,
                    "margin around the paths' bounding box within which the access point is searched");
    RADIOSLAM_FIELD(grid, "", 2, 1000, "number of points along each side of the search grid");
    RADIOSLAM_FIELD(alternative_distance_m, "m", 0.01, 1e5,
                    "smallest distance between an alternative position and the estimate");
    RADIOSLAM_FIELD(
        alternative_margin, "", 0, 1e6,
        "largest excess cost of an alternative position; 6 is chi-squared with 2 degrees of freedom at 5 %");
    RADIOSLAM_FIELD(max_sigma_m, "m", 0.1, 1e5,
                    "largest standard deviation of a localised access point along its weakest axis");
  }
};

/// RSS of the access point at a known position.
struct PlacedReading {
  Eigen::Vector2d place_m;
  double rss_dbm = 0;
};

/// Readings of one access point along known paths, and positions where it was not detected.
struct RssAlongPath {
  std::vector<PlacedReading> readings;
  std::vector<Eigen::Vector2d> undetected_m;  ///< positions without detection
  double floor_dbm = -85;                     ///< detection threshold
};

struct AccessPointFit {
  AccessPointStatus status = AccessPointStatus::kFound;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  PathLoss path_loss;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of [x, y, P0, n]
  double sigma_db = 0;     ///< shadowing and fading combined, scaled by the residuals
  std::size_t places = 0;  ///< sites that detected it
  std::optional<Eigen::Vector2d> alternative_m = {};  ///< position that fits nearly as well
};

/// Nothing where fewer than `min_places` sites detected it.
std::optional<AccessPointFit> fit_access_point(const RssAlongPath& heard, const AccessPointParams& params);

}  // namespace radioslam
