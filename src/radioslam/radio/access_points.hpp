// Where an access point is, from how strongly it was heard along known ways.
//
//   P(p) = P0 - 10 n log10 d(p) + s(p) + e,  d(p)^2 = |p - a|^2 + height^2
// for a receiver at p and the access point at a, both in the plane, with shadowing s that is alike over
// `shadowing_length_m` (Gudmundson 1991: correlation exp(-distance / length)) and fading e. Readings of one
// place are averaged; the places' noise is whitened by its Cholesky factor. P0 and n have Gaussian priors and
// are linear once a is given: a grid over the ways and around them is searched for a, and the best places of
// the grid are refined over all four by Levenberg-Marquardt with Huber's loss.
// Where it was not heard its power was below what receivers hear (a Tobit term, -2 log Phi, per cell):
// without, the far places that happened to hear it would flatten the law. The covariance is the curvature's,
// or where wider the posterior's second moment over places around. A straight way hears the same on either
// side, and weak readings are alike from everywhere: a second place that fits nearly as well is given as the
// rival. Metres and dBm. Cost: cube of the places (at most `most_places`), and its square per place of the
// grid.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/path_loss.hpp"

namespace radioslam {

struct AccessPointParams {
  int least_places = 8;       ///< fewer say nothing of a place
  double cell_m = 2;          ///< readings closer than this are of one place
  int most_places = 250;      ///< cells grow until there are no more
  double height_m = 2;        ///< of access points above receivers
  double prior_exponent = 3;  ///< n
  double prior_sigma_exponent = 0.5;
  double prior_power_dbm = -40;  ///< P0
  double prior_sigma_power_db = 8;
  double sigma_shadowing_db = 5;
  double shadowing_length_m = 6;
  double sigma_fading_db = 2;    ///< of an averaged reading
  double sigma_weight = 200;     ///< places that the two lines above are worth against the residuals
  double loss_sigmas = 2;        ///< Huber's
  double silent_cell_m = 8;      ///< places that did not hear it, closer than this, are one
  double around_m = 12;          ///< the posterior is summed over places so far around, on each side
  int around_places = 17;        ///< along each side of that
  double margin_m = 40;          ///< how far outside the ways it may be
  int grid = 16;                 ///< places along either side of the search's grid
  double rival_distance_m = 10;  ///< a place further off than this is another one
  double rival_margin = 6;       ///< in squared normalised residuals: chi-squared of 2 at 5 %
  double largest_sigma_m = 20;   ///< less certain along its loosest axis, and the place is not known

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"least_places", "", 4, 1e6, "places that heard it, at least; ours"}, self.least_places);
    visit(Field{"cell_m", "m", 0.01, 1000, "readings closer than this are of one place; ours"}, self.cell_m);
    visit(Field{"most_places", "", 10, 10000, "places at most: cells grow until there are no more"},
          self.most_places);
    visit(Field{"height_m", "m", 0.1, 100, "of access points above receivers: a ceiling"}, self.height_m);
    visit(Field{"prior_exponent", "", 1, 8, "exponent: 2 in free space, to 4 through walls"},
          self.prior_exponent);
    visit(Field{"prior_sigma_exponent", "", 1e-3, 10, "its spread; ours"}, self.prior_sigma_exponent);
    visit(
        Field{"prior_power_dbm", "dBm", -200, 100, "power at 1 m: 20 dBm less 40 dB at 2.4 GHz, less losses"},
        self.prior_power_dbm);
    visit(Field{"prior_sigma_power_db", "dB", 1e-3, 100, "its spread; ours"}, self.prior_sigma_power_db);
    visit(Field{"sigma_shadowing_db", "dB", 0.01, 100, "shadowing; 3 to 8 dB in the literature"},
          self.sigma_shadowing_db);
    visit(Field{"shadowing_length_m", "m", 0.01, 1000, "way over which it is alike; metres indoors"},
          self.shadowing_length_m);
    visit(Field{"sigma_fading_db", "dB", 0.01, 100, "fading of an averaged reading; ours"},
          self.sigma_fading_db);
    visit(
        Field{"sigma_weight", "", 0.1, 1e6, "places that both sigmas are worth against the residuals; ours"},
        self.sigma_weight);
    visit(Field{"loss_sigmas", "", 0.1, 1e6, "scale of Huber's loss; ours"}, self.loss_sigmas);
    visit(Field{"silent_cell_m", "m", 0.1, 1000, "places without it that count as one; ours"},
          self.silent_cell_m);
    visit(Field{"around_m", "m", 0.1, 1000, "how far around the posterior is summed; ours"}, self.around_m);
    visit(Field{"around_places", "", 3, 1000, "places along a side of that sum; ours"}, self.around_places);
    visit(Field{"margin_m", "m", 0, 1e5, "how far outside the ways it is searched for; ours"}, self.margin_m);
    visit(Field{"grid", "", 2, 1000, "places along either side of the search's grid; ours"}, self.grid);
    visit(Field{"rival_distance_m", "m", 0.01, 1e5, "a place further off than this is another one; ours"},
          self.rival_distance_m);
    visit(Field{"rival_margin", "", 0, 1e6, "a place that costs less than this more may be the true one"},
          self.rival_margin);
    visit(Field{"largest_sigma_m", "m", 0.1, 1e5, "a place less certain than this is not known; ours"},
          self.largest_sigma_m);
  }
};

/// How strongly the access point was heard somewhere.
struct PlacedReading {
  Eigen::Vector2d place_m;
  double rss_dbm = 0;
};

/// What was heard of one access point along known ways, and where it was not.
struct HeardAlongWays {
  std::vector<PlacedReading> readings;
  std::vector<Eigen::Vector2d> silent_m;  ///< places without it
  double floor_dbm = -85;                 ///< weaker is not heard
};

enum class AccessPointStatus {
  kFound,
  kAmbiguous,  ///< the rival fits nearly as well
  kLoose,      ///< its place is not known to better than largest_sigma_m
};

struct AccessPointFit {
  AccessPointStatus status = AccessPointStatus::kFound;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  PathLoss path_loss;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of [x, y, P0, n] around this place
  double sigma_db = 0;                                   ///< shadowing and fading together, by the residuals
  std::size_t places = 0;                                ///< that heard it
  std::optional<Eigen::Vector2d> rival_m = {};           ///< another place it may be at
};

/// Nothing where fewer than `least_places` places heard it.
std::optional<AccessPointFit> fit_access_point(const HeardAlongWays& heard, const AccessPointParams& params);

}  // namespace radioslam
