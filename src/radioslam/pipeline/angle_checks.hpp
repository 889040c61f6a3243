// Is every robot where it says it is? Each angle of arrival between two robots is held against two relative
// poses (radio/arrival_likelihood.hpp):
//   claim     what both say of themselves, their known start and their odometry alone, where both have one.
//             No estimate can bend to please a false one, but it is only as good as the odometry.
//   estimate  what the joint estimate made of everything; for all pairs.
//
// Each angle has odds that the other robot might as well be anywhere (log_odds_elsewhere). A robot may report
// falsely from some time on, or until then: the mean over a sequence of angles of the products of the odds up
// to each, and from each on, is the evidence E, of a pair or of all pairs of a robot. If the poses are right
// E has a mean of 1 at most, so it exceeds x with probability 1 / x at most (Markov), wherever the wrong
// paths fall, as long as a share P of the angles or more have a direct path, independently. A robot is
// accused where E reaches the number of robots over the false-alarm probability; the one with the largest E
// first, without whose angles the others are judged again. Robots whose E are within a factor of ten cannot
// be told apart. A pair is contradicted likewise.
//
// An estimate fits its angles, which makes E smaller. A claim is off by its odometry's errors, the same for
// all angles of a time: whatever is within z s counts as hit, s what these errors turn the direction by, the
// odometry taken `odometry_margin` times as noisy as stated, z the normal quantile for half the false-alarm
// probability per robot, of which E then has the other half.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/team_placement.hpp"
#include "radioslam/radio/arrival_likelihood.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct AngleCheckParams {
  double false_alarm_probability = 1e-3;
  double direct_probability = 0.8;
  double odometry_margin = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"false_alarm_probability", "", 1e-12, 0.5,
                "of accusing anybody in an honest team, by claims and by the estimate each"},
          self.false_alarm_probability);
    visit(Field{"direct_probability", "", 0.01, 0.999,
                "share of angle measurements that hold the direct path, at least"},
          self.direct_probability);
    visit(Field{"odometry_margin", "", 0, 100, "how much noisier than stated odometry may be, for claims"},
          self.odometry_margin);
  }
};

struct AngleChecks {
  std::vector<AngleCheckResult> pairs;  ///< by who receives and who transmits
  /// The accused, the one with the most evidence first; those who cannot be told apart together.
  std::vector<std::vector<std::string>> suspects;
};

/// The robots' own claims, and anchors of known places, which are never suspects.
template <class Pose>
AngleChecks check_claims(const Mission& mission, const JointGraphParams& graph,
                         const ArrivalLikelihoodParams& likelihood, const AngleCheckParams& params);

/// The estimate in `joint`, which is that of `mission`, of the robots that share a frame.
template <class Pose>
AngleChecks check_estimate(const Mission& mission, const JointGraph<Pose>& joint,
                           const TeamPlacement<Pose>& placement, const ArrivalLikelihoodParams& likelihood,
                           const AngleCheckParams& params);

/// What to tell a user of the suspects.
std::vector<std::string> angle_notes(const AngleChecks& checks, CheckedPose pose);

}  // namespace radioslam
