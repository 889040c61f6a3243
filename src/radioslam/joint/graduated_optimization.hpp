// Graduated optimization of a joint graph with outlier closures (Blake and Zisserman 1987): the closures'
// loss starts nearly quadratic, which widens the basin of convergence, and is narrowed stage by stage to its
// final scale, where outliers have no influence.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {

struct RobustParams {
  double first_scale = 4;
  double final_scale = 1;
  double step = 0.5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(first_scale, "sigma", 0.1, 1e6,
                    "Cauchy loss scale of closures in the first stage; higher values converge from further "
                    "away but take more stages");
    RADIOSLAM_FIELD(final_scale, "sigma", 0.1, 1e6,
                    "Cauchy loss scale of closures in the last stage; lower values reject more outliers");
    RADIOSLAM_FIELD(step, "", 0.01, 0.99, "ratio of successive loss scales; higher values take more stages");
  }
};

/// Iterations are summed over all stages; costs are those of the last one.
template <class Pose>
OptimizerSummary optimize_robustly(JointGraph<Pose>& joint, const RobustParams& robust,
                                   const OptimizerParams& optimizer, const Progress& progress = {});

}  // namespace radioslam
