// Robust losses: what a factor adds to the cost, and the weight that iteratively reweighted least squares
// gives it, w = d rho / d s, for s its squared Mahalanobis norm. Kinds and formulas: LossKind.
#pragma once

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

struct LossValue {
  double cost = 0;
  double weight = 1;  ///< in (0, 1]; 1 at s = 0
};

LossValue evaluate(const Loss& loss, double squared_norm);

}  // namespace radioslam
