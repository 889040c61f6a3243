// Optimises a joint graph whose closures may be wrong: the loss starts nearly quadratic, so that a start far
// from the solution is pulled in by all closures together, and is then narrowed step by step to its final
// scale, where wrong closures no longer count (graduated optimisation; Blake and Zisserman 1987).
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/pipeline/joint_graph.hpp"

namespace radioslam {

struct RobustParams {
  double first_scale = 4;  ///< loss scale of the first solution
  double final_scale = 1;  ///< of the last one
  double step = 0.5;       ///< ratio of one scale to the last

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"first_scale", "sigma", 0.1, 1e6, "scale of the closures' Cauchy loss at the start"},
          self.first_scale);
    visit(Field{"final_scale", "sigma", 0.1, 1e6, "scale at the end"}, self.final_scale);
    visit(Field{"step", "", 0.01, 0.99, "ratio of one scale to the last"}, self.step);
  }
};

/// Sum over the stages; costs are of the last one.
template <class Pose>
OptimizerSummary optimize_robustly(JointGraph<Pose>& joint, const RobustParams& robust,
                                   const OptimizerParams& optimizer, const Progress& progress = {});

}  // namespace radioslam
