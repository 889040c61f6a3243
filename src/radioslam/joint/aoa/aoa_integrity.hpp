// AoA integrity test: finds robots whose pose contradicts the angles of arrival measured between robots.
//
// Every angle is compared with two relative poses (radio/aoa/aoa_likelihood.hpp):
//   self-reported  known starts and odometry alone, where both robots have them: independent of the joint
//                  estimate, but only as accurate as the odometry
//   estimate       the joint estimate, for all pairs
//
// An angle's likelihood ratio is that of "the other robot is elsewhere" to the compared pose
// (log_odds_elsewhere). The evidence E of a pair, or of all pairs of a robot, is the mean of the products of
// these ratios up to each angle and from each angle on, since a report may be false only from, or until, some
// time. If the poses are right, E has a mean of at most 1 and exceeds x with probability at most 1 / x
// (Markov), wherever outliers fall, provided that at least `direct_probability` of the angles contain the
// direct path, independently. A robot is a suspect if E reaches (number of robots) / (false-alarm
// probability). The largest E comes first; the remaining robots are tested again without its angles. Robots
// whose E differ by less than a factor of ten form one group. Pairs are tested by the same rule.
//
// Self-reported poses carry odometry errors common to all angles of a time: deviations within z s count as
// agreement, s being the direction error from odometry noise times `odometry_margin`, z the normal quantile
// of half the false-alarm probability per robot; E uses the other half.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct AoaIntegrityParams {
  double false_alarm_probability = 1e-3;
  double direct_probability = 0.8;
  double odometry_margin = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(false_alarm_probability, "", 1e-12, 0.5,
                    "probability of a false suspect in a team of correct poses, for self-reported and for "
                    "estimated poses each");
    RADIOSLAM_FIELD(direct_probability, "", 0.01, 0.999,
                    "lower bound on the ratio of angle measurements that contain the direct path; lower "
                    "values weaken the test");
    RADIOSLAM_FIELD(
        odometry_margin, "", 0, 100,
        "factor on the stated odometry noise when self-reported poses are tested; higher values accuse less");
  }
};

struct AoaIntegrity {
  std::vector<AoaIntegrityResult> pairs;  ///< by receiver and transmitter
  /// Groups of suspects, largest evidence first; members of a group cannot be distinguished.
  std::vector<std::vector<std::string>> suspects;
};

/// Tests self-reported poses. Anchors of known position take part but are never suspects.
template <class Pose>
AoaIntegrity check_self_reports(const Mission& mission, const JointGraphParams& graph,
                                const AoaLikelihoodParams& likelihood, const AoaIntegrityParams& params);

/// Tests the estimate of `mission` in `joint`, for robots with a common frame.
template <class Pose>
AoaIntegrity check_estimate(const Mission& mission, const JointGraph<Pose>& joint,
                            const TeamAlignment<Pose>& alignment, const AoaLikelihoodParams& likelihood,
                            const AoaIntegrityParams& params);

/// Notes for the user, one per group of suspects.
std::vector<std::string> angle_notes(const AoaIntegrity& checks, CheckedPose pose);

}  // namespace radioslam
