// Loop closures that may be wrong, in a graph that is solved without a centre: graduated non-convexity with
// truncated least squares (graduated.hpp). The robot that holds a factor weighs it; how convex the loss still
// is, everybody hears from the root with the steps.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/graph/distributed/robot_graph.hpp"

namespace radioslam {

struct OutlierParams {
  double gate = 0;         ///< c^2: squared norm up to which a factor may be right; 0: all are
  double first_cut = 100;  ///< norm beyond which factors are left out at first, in units of c
  double mu_factor = 2;
  double last_mu = 100;

  double first_mu() const { return 1 / (first_cut * first_cut - 1); }

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(gate, "", 0, 1e9,
                          "squared Mahalanobis norm up to which a loop closure may be right; 0: all are");
    RADIOSLAM_FIELD(
        first_cut, "", 1.1, 1e6,
        "norm beyond which closures are left out in the first sweep, relative to that of the gate");
    RADIOSLAM_FIELD(mu_factor, "", 1.01, 100, "factor by which the loss sharpens from sweep to sweep");
    RADIOSLAM_FIELD(last_mu, "", 1, 1e9, "sharpness of the loss at which the sweeps go on to the end");
  }
};

struct TruncatedWeight {
  double weight = 1;
  double penalty = 0;  ///< what the surrogate adds to weight * squared norm
};
TruncatedWeight truncated_weight(double squared_norm, double gate, double mu);

/// Several relative poses between the same two poses are hardly independent: together they weigh as one.
/// Each robot knows all of those it has part in.
template <class Pose>
void discount_repeated(PoseGraph<Pose>& graph);

/// Per relative pose: whether it is a loop closure. The first between a pose and the next one is odometry.
template <class Pose>
std::vector<bool> outlier_candidates(const RobotGraph<Pose>& robot);

}  // namespace radioslam
