// Constant errors of ranges, one per pair of antennas, estimated together with the trajectories and kept only
// where they show. UWB and WiFi ranging are tenths of a metre too long until somebody calibrates every pair.
//
// Each pair with enough ranges starts from the middle of the shortest interval that holds half of its
// residuals, which late paths move little. Biases and trajectories are then optimised together, the ranges'
// weights being the posteriors that they are direct, in turn until these settle. All biases are kept or none:
// single ones trade off against each other through the trajectories. They show when b^T C^-1 b exceeds the
// chi-squared quantile of as many degrees of freedom, C their joint covariance, larger by as much as the
// ranges' residuals are larger than stated and by how many of them in a row err together: hundreds of ranges
// with one reflection would else prove any small error. Then they are taken to
// be of one make: the spread comes from b and C (empirical Bayes; Morris 1983), their mean becomes a
// variable, and everything is optimised again, so that a pair whose ranges cannot tell is given what the
// others show. Metres; measured = distance + bias.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

struct TeamBiasParams {
  double prior_sigma_m = 0.5;
  double false_alarm_probability = 6e-7;
  double least_spread_m = 0.05;
  int least_ranges = 10;
  int most_rounds = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"prior_sigma_m", "m", 0, 100,
                "how large a constant error of ranges may be, per pair of antennas; 0: none is estimated"},
          self.prior_sigma_m);
    visit(Field{"false_alarm_probability", "", 1e-9, 0.5,
                "of taking off errors where there are none; five sigma"},
          self.false_alarm_probability);
    visit(Field{"least_spread_m", "m", 1e-4, 100, "by which the errors of different pairs differ, at least"},
          self.least_spread_m);
    visit(Field{"least_ranges", "", 2, 1e6, "of a pair whose error is estimated"}, self.least_ranges);
    visit(Field{"most_rounds", "", 1, 100, "of biases and weights in turn"}, self.most_rounds);
  }
};

/// Adds biases to the graph's ranges where they show and moves its values to the new optimum; without any,
/// the graph stays as it is. Ranges of closures have none. Returns what was kept, in the order of the pairs.
template <class Pose>
std::vector<RangeBiasResult> estimate_range_biases(JointGraph<Pose>& joint, const TeamBiasParams& params,
                                                   const MixtureParams& mixture,
                                                   const OptimizerParams& optimizer,
                                                   const Progress& progress = {});

}  // namespace radioslam
