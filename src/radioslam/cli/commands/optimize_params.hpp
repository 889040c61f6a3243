// Parameters of `radioslam optimize`.
#pragma once

#include "radioslam/graph/distributed/team_optimization.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam::cli {

struct OptimizeParams {
  OptimizerParams optimizer;
  TeamOptimizationParams distributed;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    OptimizerParams::visit_fields(self.optimizer, visit);
  }
  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("distributed", self.distributed);
  }
};

}  // namespace radioslam::cli
