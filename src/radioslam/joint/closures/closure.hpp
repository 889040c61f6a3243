// Loop closure: a relative pose that was measured between any two poses of the team, whoever measured it.
//
// Scans, an external place recognition, sequences of fingerprints and the edges of a graph file all give
// closures, of one robot or between two; what an estimate says of each is kept apart.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct Closure {
  ClosureKind kind = ClosureKind::kMatch;
  RobotIndex robot_i, robot_j;
  Stamp stamp_i, stamp_j;  ///< of poses of the joint graph, once it hangs on them; or times without odometry
  SE3 T_i_j;
  SE3::Jacobian information = SE3::Jacobian::Identity();  ///< of T_i_j Exp(xi), [translation, rotation]
};

struct ClosureJudgement {
  ClosureStatus status = ClosureStatus::kAccepted;
  double statistic = 0;              ///< squared normalised residual that was tested
  std::string reason;                ///< of a rejection; empty if accepted
  std::optional<double> doubt = {};  ///< of a scan: probability that another place explains it
};

/// A closure and what its verification says of it, the first judgement.
struct VerifiedClosure {
  Closure closure;
  ClosureJudgement judgement = {};
};

/// Whether a closure may take part when those that hold are chosen.
enum class Admission {
  kAdmitted,
  kSetAside,  ///< not, but it may hold once others between the same trajectories do
  kExcluded,
};

/// What other evidence says of a closure alone (closure_admission.hpp).
struct ClosureAdmission {
  Admission admission = Admission::kAdmitted;
  std::string reason = {};  ///< why not
  double information_scale = 1;
};

/// Appends to lists of the same order.
void append(const std::vector<VerifiedClosure>& verified, std::vector<Closure>& closures,
            std::vector<ClosureJudgement>& judgements);

/// Information of a relative pose in the dimension of the estimate; in the plane, height, roll and pitch are
/// marginalised.
template <class Pose>
typename Pose::Jacobian information_as(const SE3::Jacobian& information);

/// Information of a relative pose of the estimate; of one in the plane, next to none on height, roll and
/// pitch.
template <class Pose>
SE3::Jacobian information_in_space(const typename Pose::Jacobian& information);

/// Covariance of T_i_j in the dimension of the estimate.
template <class Pose>
typename Pose::Jacobian covariance_of(const Closure& closure);

/// Poses of a closure's ends in the joint graph; invalid outside the odometry.
struct ClosureEnds {
  PoseId i, j;
  bool valid() const { return i.valid() && j.valid(); }
};
template <class Pose>
ClosureEnds closure_ends(const JointGraph<Pose>& joint, const Closure& closure);

void reject(ClosureJudgement& judgement, std::string reason);

/// The mission's matches, in their order.
std::vector<Closure> closures_of_matches(const Mission& mission);

/// Moves closures whose ends are both within the odometry to the keyframes before these, by the odometry in
/// between, whose covariance adds to theirs.
template <class Pose>
void hang_on_keyframes(const JointGraph<Pose>& joint, const Mission& mission, std::vector<Closure>& closures);

/// The closure as a factor between its ends, which must be valid; without a loss.
template <class Pose>
RelativePoseFactor<Pose> closure_factor(const JointGraph<Pose>& joint, const Closure& closure);

/// Adds a factor of a closure; its origin's measurement is `index`.
template <class Pose>
void add_closure(JointGraph<Pose>& joint, const Closure& closure, RelativePoseFactor<Pose> factor,
                 FactorSource source, std::size_t index);

/// Accepts, of the closures whose factors are in the graph, those whose residual there passes the chi-squared
/// test; the others stay as they are.
template <class Pose>
void test_closures(const JointGraph<Pose>& joint, FactorSource source,
                   std::vector<ClosureJudgement>& judgements);

/// Outcomes, at the keyframes before both ends.
template <class Pose>
std::vector<ClosureResult> collect_closures(const JointGraph<Pose>& joint,
                                            const std::vector<Closure>& closures,
                                            const std::vector<ClosureJudgement>& judgements);

// LiDAR loop closures within each robot, as factors of the joint graph.

/// A loop by scan matching between the scans at these stamps; the statistic is its inlier ratio.
VerifiedClosure closure_of_scan(RobotIndex robot_i, Stamp stamp_i, RobotIndex robot_j, Stamp stamp_j,
                                const ScanLoop& loop);

/// In their order; the statistic of those that scan matching rejected is the inlier ratio.
std::vector<VerifiedClosure> closures_of_scans(const std::vector<ScanClosure>& scans);

/// Adds the accepted closures of robots with themselves, each with a loss.
template <class Pose>
void add_scan_closures(JointGraph<Pose>& joint, const std::vector<VerifiedClosure>& closures);

/// Moves every robot's trajectory as its loop closures moved its scanned keyframes; it stays in its frame.
template <class Pose>
void correct_by_scans(JointGraph<Pose>& joint, const Mission& mission, const MeasuredScans& scans);

}  // namespace radioslam
