// Graduated non-convexity (GNC): robust optimization that does not depend on a good start. The surrogate of
// the loss is nearly convex at first and becomes the loss as mu moves, each round a weighted least squares
// problem. Source: Yang, Antonante, Tzoumas, Carlone 2020, Graduated non-convexity for robust spatial
// perception. With s the squared Mahalanobis norm, c the factor's loss scale, per round:
//   Geman-McClure  w = (mu c^2 / (s + mu c^2))^2,  mu: 2 max s / c^2 down to 1
//   truncated      w = 1 up to s = c^2 mu / (mu + 1), 0 from c^2 (mu + 1) / mu on,
//                  c sqrt(mu (mu + 1) / s) - mu between,  mu: c^2 / (2 max s - c^2) up
#pragma once

#include <vector>

#include "radioslam/graph/optimizer.hpp"

namespace radioslam {

enum class GraduatedLoss { kGemanMcClure, kTruncatedLeastSquares };

/// w of the formulas above, of a factor with squared Mahalanobis norm s and squared loss scale c2.
double surrogate_weight(GraduatedLoss loss, double mu, double s, double c2);

struct GraduatedParams {
  double mu_factor = 1.4;
  int max_rounds = 100;  ///< the last round is solved at the loss itself, or at this mu
  int steps_per_round = 10;
  double settled_weight_gap = 1e-3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(mu_factor, "", 1.01, 10,
                    "factor by which the convexity parameter changes per round of graduated optimization "
                    "(Yang et al. 2020)");
    RADIOSLAM_FIELD(max_rounds, "", 1, 10000, "largest number of rounds of graduated optimization");
    RADIOSLAM_FIELD(steps_per_round, "", 1, 1000,
                    "largest number of linear solves per round of graduated optimization, except the last");
    RADIOSLAM_FIELD(settled_weight_gap, "", 0, 0.5,
                    "distance of all weights from 0 or 1 below which truncated graduated optimization ends");
  }
};

/// One entry per factor of a list; an empty list selects no factor.
struct FactorMask {
  std::vector<bool> relative_poses, ranges, bearings, relative_points, positions;
};
/// Weights in [0, 1]; 1 for factors outside the mask. Below one half counts as rejected.
struct FactorWeights {
  std::vector<double> relative_poses, ranges, bearings, relative_points, positions;
};

/// The factors whose loss is kGemanMcClure.
template <class Pose>
FactorMask geman_mcclure_factors(const PoseGraph<Pose>& graph);

struct GraduatedSummary {
  FactorWeights weights;  ///< of the last round
  int rounds = 0;
  int iterations = 0;     ///< linear systems solved in all rounds
  OptimizerSummary last;  ///< of the last round, solved to the end with these weights
};

/// Moves the graph's values to the robust optimum from where they are. Factors in the mask are taken as
/// outlier candidates with their loss's scale, whatever its kind; the others keep their loss. Measurements,
/// weights and losses of the graph stay as they are.
template <class Pose>
GraduatedSummary optimize_graduated(PoseGraph<Pose>& graph, const FactorMask& mask, GraduatedLoss loss,
                                    const GraduatedParams& params, const OptimizerParams& optimizer,
                                    const Progress& progress = {});

/// Multiplies the factors' weights; those of the mask lose their loss. For marginals and costs of the result.
template <class Pose>
void apply_weights(const FactorWeights& weights, const FactorMask& mask, PoseGraph<Pose>& graph);

}  // namespace radioslam
