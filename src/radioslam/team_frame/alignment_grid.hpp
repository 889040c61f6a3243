// Grid search for the relative pose, seen from above, of a trajectory that is not placed yet: the likelihood
// of all links on a grid of relative poses between the two ends of one link, the reference.
//
// Let the reference's ends, one on the placed trajectory p and one on the free trajectory f, be d apart in
// direction phi, with a heading difference theta:
//   b = d (cos phi, sin phi) + R(theta) b_f,   v = b - a
// maps a link's free end b_f (in f's frame) next to its placed end a (in p's frame). A range is compared with
// |v|, an angle of arrival with the direction of v seen from its receiver. Each variance is the measurement's
// own plus what the covariance of both ends relative to the reference and the size of the cell add. Both
// likelihoods are mixtures (measurement_mixture.hpp). In space the free end's height z has a standard
// deviation s_z about that by odometry: to a range it adds s_z^2 (z / |v|)^2 + s_z^4 / (2 d^2), and the best
// cells are scored again at other heights. Links are treated as independent although odometry errors
// correlate them, so scores only rank start poses for a refinement. Cost: cells x links.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

struct GridParams {
  int angle_steps = 60;
  double distance_ratio = 1.5;
  double sigma_height_m = 10;
  int references = 8;
  int peaks = 10;
  int max_links = 80;
  int max_links_of_robot = 240;
  int max_sightings = 20;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(angle_steps, "", 8, 720,
                    "number of directions, and of headings, tried per full turn in the alignment grid");
    RADIOSLAM_FIELD(distance_ratio, "", 1.05, 10,
                    "ratio of successive distances tried between two robots where no range was measured");
    RADIOSLAM_FIELD(sigma_height_m, "m", 0, 1e4,
                    "standard deviation of the unknown height difference between two robots' start frames");
    RADIOSLAM_FIELD(references, "", 1, 1000, "number of links tried as the reference of an alignment grid");
    RADIOSLAM_FIELD(peaks, "", 1, 1000, "number of best cells kept per alignment grid");
    RADIOSLAM_FIELD(max_links, "", 1, 1e6,
                    "largest number of ranges per pair of robots, and of angles per receiver, in the "
                    "alignment search; more are thinned evenly");
    RADIOSLAM_FIELD(max_links_of_robot, "", 8, 1e6,
                    "largest number of ranges, and of received angles, per trajectory segment in the "
                    "alignment search; every pair keeps at least 8");
    RADIOSLAM_FIELD(max_sightings, "", 1, 1e6,
                    "largest number of sightings of one point per robot in the alignment search; more are "
                    "thinned evenly");
  }
};

/// End of a link, in the frame of the reference's end on the same trajectory.
struct GridEnd {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y (in that frame) and heading
  double height_m = 0;
};

struct GridRange {
  GridEnd placed, free;
  double range_m = 0, sigma_m = 1;
};

struct GridBearing {
  GridEnd placed, free;
  bool received_by_placed = true;
  std::vector<double> azimuth_rad;  ///< of each path, in the receiver's levelled body frame
  std::vector<double> sigma_rad, prior;
  std::vector<std::optional<double>> elevation_rad =
      {};  ///< of each path, levelled; empty: none was measured
};

struct DistanceCell {
  double distance_m = 0, sigma_m = 0;
};

struct GridProblem {
  std::vector<GridRange> ranges;
  std::vector<GridBearing> bearings;
  std::vector<DistanceCell> distances;
  std::optional<std::pair<double, double>> heading;  ///< theta and its standard deviation, where known
  double height_m = 0;                               ///< of the free end above the placed end, by odometry
  double sigma_height_m = 0;                         ///< of `height_m`; 0: known
  double span_m = 1;                                 ///< width of the uniform density of false ranges
  MixtureParams mixture;
};

struct GridCell {
  double distance_m = 0, sigma_distance_m = 0, phi_rad = 0, theta_rad = 0;
  double rise_m = 0, sigma_rise_m = 0;  ///< of the free end above the problem's height_m
  double score = 0;                     ///< log likelihood
};

/// Local maxima of the grid, best first.
std::vector<GridCell> best_cells(const GridProblem& problem, const GridParams& params);

/// The cell at the heights that explain its links best: local maxima of the likelihood, at most two, since
/// ranges and azimuths on level ground do not distinguish above from below. The cell alone if the height is
/// known.
std::vector<GridCell> at_best_heights(const GridProblem& problem, const GridCell& cell,
                                      const GridParams& params);

/// Variance that the cell's size and the odometry add to every range (m^2) and every bearing (rad^2).
VarianceInflation propagated_variances(const GridProblem& problem, const GridCell& cell,
                                       const GridParams& params);

}  // namespace radioslam
