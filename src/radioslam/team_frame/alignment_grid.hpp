// Where a free trajectory may lie relative to a placed one, seen from above: the likelihood of all links over
// a grid of relative poses of one link's two ends, its reference.
//
// The reference's ends p (placed) and f (free) are d apart in direction phi, and f's heading differs by
// theta:
//   b = d (cos phi, sin phi) + R(theta) b_f,   v = b - a
// puts a link's free end b_f (in f's frame) against its placed end a (in p's frame). A range is held against
// |v|, an angle against the direction of v seen from its receiver; each with its own variance plus what
// follows from the covariance of both ends' ways from the reference and from the size of the cell. Both terms
// are mixtures, as in measurement_mixture.hpp. Links are taken as independent, which the ways' errors are
// not: the scores rank places to start from, no more. Cost: cells x links.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

struct GridParams {
  int angle_steps = 60;         ///< cells of phi and of theta in a full turn
  double distance_ratio = 1.5;  ///< of the distances tried, up to the radio's reach, where none was measured
  double sigma_height_m = 3;    ///< unknown difference of two starts' heights
  int references = 8;           ///< links tried as reference
  int peaks = 10;               ///< places kept of each
  int most_links = 80;          ///< between two pieces, or a piece and a point; more are thinned evenly
  int most_sightings = 20;      ///< of one point by one piece, likewise

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"angle_steps", "", 8, 720, "directions and headings tried in a full turn"}, self.angle_steps);
    visit(Field{"distance_ratio", "", 1.05, 10, "each distance tried to the one before it"},
          self.distance_ratio);
    visit(Field{"sigma_height_m", "m", 0, 1e4, "unknown difference of two starts' heights"},
          self.sigma_height_m);
    visit(Field{"references", "", 1, 1000, "links tried as the one to start from"}, self.references);
    visit(Field{"peaks", "", 1, 1000, "places kept for each of them"}, self.peaks);
    visit(Field{"most_links", "", 1, 1e6, "more links of two robots than this are thinned for the search"},
          self.most_links);
    visit(Field{"most_sightings", "", 1, 1e6, "more sightings of one point by one robot likewise"},
          self.most_sightings);
  }
};

/// An end of a link in the frame of the reference's end on its side.
struct GridEnd {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y (that frame) and heading
  double height_m = 0;
};

struct GridRange {
  GridEnd placed, free;
  double range_m = 0, sigma_m = 1;
};

struct GridBearing {
  GridEnd placed, free;
  bool received_by_placed = true;
  std::vector<double> azimuth_rad;  ///< of the paths, in the receiver's level body frame
  std::vector<double> sigma_rad, prior;
};

struct DistanceCell {
  double distance_m = 0, sigma_m = 0;
};

struct GridProblem {
  std::vector<GridRange> ranges;
  std::vector<GridBearing> bearings;
  std::vector<DistanceCell> distances;
  std::optional<std::pair<double, double>> heading;  ///< theta, where it is known, and its sigma
  double height_m = 0;                               ///< free end's over the placed end's, by odometry
  double span_m = 1;                                 ///< of a false range
  MixtureParams mixture;
};

struct GridCell {
  double distance_m = 0, sigma_distance_m = 0, phi_rad = 0, theta_rad = 0;
  double score = 0;  ///< log likelihood
};

/// The best peaks of the grid, best first.
std::vector<GridCell> best_cells(const GridProblem& problem, const GridParams& params);

/// What cell and ways add to the variance of every range (m^2) and every bearing (rad^2).
Inflation propagated_variances(const GridProblem& problem, const GridCell& cell, const GridParams& params);

}  // namespace radioslam
