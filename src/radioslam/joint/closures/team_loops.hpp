// Loops of a team as the joint estimate uses them: closures between two poses of the graph, where repetitions
// of one measurement count once.
//
// Closures between the same two poses that agree within their noise are one measurement, whose errors they
// share: place recognition that reports a pair of scans again and again adds nothing. They become one loop,
// with the mean of their relative poses and the covariance of one.
// A loop is more likely true than wrong while the density N(e; 0, S) of its error exceeds that of wrong ones,
// uniform over all relative poses that the two trajectories allow: up to the squared norm
//   gate = 2 log(volume / sqrt(det(2 pi S))).
// True loops have heavier tails than their stated covariances, and wrong ones are rarely near.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/consistency/pose_chain.hpp"
#include "radioslam/joint/closures/closure.hpp"

namespace radioslam {

template <class Pose>
struct TeamLoop {
  PoseId i, j;
  std::size_t segment_i = 0, segment_j = 0;
  Pose T_i_j;
  typename Pose::Jacobian covariance = Pose::Jacobian::Identity();  ///< right perturbation
  double gate = 0;                    ///< largest squared norm of its error at which it holds
  std::vector<std::size_t> closures;  ///< indices of the closures that measured it, at least one
  Admission admission = Admission::kAdmitted;
  bool accepted = false;
  double statistic = 0;

  bool is_own() const { return segment_i == segment_j; }
};

/// The loops of those closures that have both ends in the graph, in the order of their first closures.
/// `admissions`: in the order of the closures, or none where all are admitted as measured.
template <class Pose>
std::vector<TeamLoop<Pose>> team_loops(const JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                                       const std::vector<ClosureAdmission>& admissions = {});

/// The loop as a factor without loss, of weight one.
template <class Pose>
RelativePoseFactor<Pose> loop_factor(const TeamLoop<Pose>& loop);

}  // namespace radioslam
