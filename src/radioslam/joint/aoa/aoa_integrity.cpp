#include "radioslam/joint/aoa/aoa_integrity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/joint/aoa/aoa_match_weights.hpp"
#include "radioslam/joint/keyframe_poses.hpp"
#include "radioslam/joint/links/radio_factors.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

/// Robots come first, then anchors.
using Node = std::size_t;
using Pair = std::pair<Node, Node>;

Node node_of(const LinkEnd& end, const Mission& mission) {
  return end.robot.valid() ? end.robot.index() : mission.robots.size() + end.anchor.index();
}

const std::string& name_of(Node node, const Mission& mission) {
  const std::size_t robots = mission.robots.size();
  return node < robots ? mission.robots[node].id : mission.anchors[node - robots].id;
}

/// An angle of arrival compared with a relative pose.
struct CheckedAngle {
  Node receiver = 0, transmitter = 0;
  Stamp stamp;
  AoaAgreement check;
  double log_odds = 0;

  Pair pair() const { return std::minmax(receiver, transmitter); }
};
using Angles = std::vector<const CheckedAngle*>;

/// log E of angles in temporal order: E is the mean of the products up to each angle and from each angle on.
double log_evidence(const Angles& angles) {
  if (angles.empty()) return 0;
  std::vector<double> sums;
  double before = 0, whole = 0;
  for (const CheckedAngle* angle : angles) sums.push_back(whole += angle->log_odds);
  for (const CheckedAngle* angle : angles) {
    sums.push_back(whole - before);
    before += angle->log_odds;
  }
  const double largest = *std::max_element(sums.begin(), sums.end());
  double mean = 0;
  for (const double part : sums) mean += std::exp(part - largest) / static_cast<double>(sums.size());
  return largest + std::log(mean);
}

/// Ratio of the false-alarm probability used by E; for self-reported poses the other half covers odometry
/// errors.
double evidence_ratio(CheckedPose pose) { return pose == CheckedPose::kSelfReported ? 0.5 : 1; }

/// Applies the same test to all pairs and all robots.
class IntegrityTest {
 public:
  IntegrityTest(const Mission& mission, CheckedPose pose, const AoaIntegrityParams& params,
                std::vector<CheckedAngle> angles)
      : mission_(mission), pose_(pose), params_(params), angles_(std::move(angles)) {
    std::stable_sort(angles_.begin(), angles_.end(),
                     [](const CheckedAngle& a, const CheckedAngle& b) { return a.stamp < b.stamp; });
  }

  AoaIntegrity run() const {
    std::map<Pair, Angles> pairs, directed;
    for (const CheckedAngle& angle : angles_) {
      pairs[angle.pair()].push_back(&angle);
      directed[{angle.receiver, angle.transmitter}].push_back(&angle);
    }
    AoaIntegrity checks;
    for (const auto& [ends, angles] : directed) {
      const double evidence = log_evidence(pairs.at(std::minmax(ends.first, ends.second)));
      AoaIntegrityResult result = summary(angles);
      result.receiver = name_of(ends.first, mission_);
      result.transmitter = name_of(ends.second, mission_);
      result.p_value = std::min(1.0, std::exp(-evidence));
      result.contradicted = evidence >= needed(pairs.size());
      checks.pairs.push_back(std::move(result));
    }
    checks.suspects = suspects();
    return checks;
  }

 private:
  /// log of the evidence that a test among `tests` pairs or robots requires.
  double needed(std::size_t tests) const {
    return std::log(static_cast<double>(tests) / (evidence_ratio(pose_) * params_.false_alarm_probability));
  }

  AoaIntegrityResult summary(const Angles& angles) const {
    AoaIntegrityResult result;
    result.pose = pose_;
    result.measurements = angles.size();
    std::vector<double> weights;
    std::size_t beyond = 0;
    for (const CheckedAngle* angle : angles) {
      weights.push_back(angle->check.weight);
      beyond += angle->check.status == AngleStatus::kBeyond ? 1U : 0U;
    }
    result.median_weight = upper_median(std::move(weights));
    result.outlier_ratio = static_cast<double>(beyond) / static_cast<double>(angles.size());
    return result;
  }

  /// log E of every robot, from angles that involve none of the `cleared`.
  std::map<Node, double> evidence_of_robots(const std::set<Node>& cleared) const {
    std::map<Node, Angles> of_robot;
    for (const CheckedAngle& angle : angles_) {
      if (cleared.contains(angle.receiver) || cleared.contains(angle.transmitter)) continue;
      of_robot[angle.receiver].push_back(&angle);
      if (angle.transmitter < mission_.robots.size()) of_robot[angle.transmitter].push_back(&angle);
    }
    std::map<Node, double> evidence;
    for (const auto& [robot, angles] : of_robot) evidence[robot] = log_evidence(angles);
    return evidence;
  }

  std::vector<std::vector<std::string>> suspects() const {
    const double kAlike = std::log(10.0);
    std::vector<std::vector<std::string>> groups;
    std::set<Node> accused;
    while (true) {
      const auto evidence = evidence_of_robots(accused);
      double most = needed(mission_.robots.size());
      bool any = false;
      for (const auto& [robot, e] : evidence)
        if (e >= most) most = e, any = true;
      if (!any) return groups;
      groups.emplace_back();
      for (const auto& [robot, e] : evidence)
        if (e >= most - kAlike && accused.insert(robot).second)
          groups.back().push_back(name_of(robot, mission_));
    }
  }

  const Mission& mission_;
  CheckedPose pose_;
  AoaIntegrityParams params_;
  std::vector<CheckedAngle> angles_;
};

/// Compares the measurement with the relative pose; deviations up to `band_sigmas` times the pose's direction
/// error count as agreement.
template <class Pose>
CheckedAngle checked(const UncertainPose<Pose>& T_receiver_transmitter, const AoaMeasurement& aoa,
                     const Mission& mission, const AoaLikelihoodParams& likelihood,
                     const AoaIntegrityParams& params, double band_sigmas) {
  const SE3 T_start_receiver = *mission.robots[aoa.receiver.index()].odometry.at(aoa.stamp);
  const double band_rad = band_sigmas * direction_sigma(T_receiver_transmitter).azimuth_rad;
  return {
      aoa.receiver.index(), node_of(aoa.transmitter, mission), aoa.stamp,
      check_angles(T_receiver_transmitter, aoa, mission, likelihood),
      log_odds_elsewhere(as_se3(T_receiver_transmitter.pose, 0), as_estimated<Pose>(aoa, T_start_receiver),
                         params.direct_probability, band_rad, likelihood)};
}

bool covers(const Mission& mission, RobotIndex robot, Stamp stamp) {
  return mission.robots[robot.index()].odometry.covers(stamp);
}

/// Self-reported poses of a robot at the stamps of the angles.
template <class Pose>
using Claims = std::map<Stamp, UncertainPose<Pose>>;

template <class Pose>
Claims<Pose> claims_of(RobotIndex robot, const Mission& mission, const JointGraphParams& graph) {
  const auto start = common_from_start(mission.robots[robot.index()]);
  if (!start) return {};
  typename Pose::Tangent variance = Pose::Tangent::Constant(graph.sigma_start_m * graph.sigma_start_m);
  variance.template tail<Pose::kDof - Pose::kDim>().setConstant(graph.sigma_start_rad *
                                                                graph.sigma_start_rad);
  const UncertainPose<Pose> T_common_start{pose_as<Pose>(*start), variance.asDiagonal()};
  std::set<Stamp> stamps;
  for (const AoaMeasurement& aoa : mission.aoa_measurements)
    if ((aoa.receiver == robot || aoa.transmitter.robot == robot) && covers(mission, robot, aoa.stamp))
      stamps.insert(aoa.stamp);
  const std::vector<Stamp> in_order(stamps.begin(), stamps.end());
  const auto since_start = odometry_since_start<Pose>(mission.robots[robot.index()], in_order);
  Claims<Pose> claims;
  for (std::size_t k = 0; k < in_order.size(); ++k) claims[in_order[k]] = T_common_start * since_start[k];
  return claims;
}

template <class Pose>
std::optional<UncertainPose<Pose>> claim_of_anchor(const Anchor& anchor) {
  if (!anchor.position_m) return std::nullopt;
  UncertainPose<Pose> claim;
  typename Pose::Tangent position = Pose::Tangent::Zero();
  position.template head<Pose::kDim>() = anchor.position_m->template head<Pose::kDim>();
  claim.pose = Pose::exp(position);
  claim.covariance.diagonal().template head<Pose::kDim>().setConstant(anchor.sigma_m * anchor.sigma_m);
  return claim;
}

}  // namespace

template <class Pose>
AoaIntegrity check_self_reports(const Mission& mission, const JointGraphParams& graph,
                                const AoaLikelihoodParams& likelihood, const AoaIntegrityParams& params) {
  std::vector<Claims<Pose>> claims;
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    claims.push_back(claims_of<Pose>(RobotIndex(r), mission, graph));
  const auto claim = [&](const LinkEnd& end, Stamp stamp) -> std::optional<UncertainPose<Pose>> {
    if (!end.robot.valid()) return claim_of_anchor<Pose>(mission.anchors[end.anchor.index()]);
    const auto& of_robot = claims[end.robot.index()];
    const auto found = of_robot.find(stamp);
    return found == of_robot.end() ? std::nullopt : std::optional(found->second);
  };
  const double false_alarm =
      (1 - evidence_ratio(CheckedPose::kSelfReported)) * params.false_alarm_probability;
  const auto robots = static_cast<double>(std::max<std::size_t>(mission.robots.size(), 1));
  const double band = params.odometry_margin * std::sqrt(chi_squared_quantile(1 - false_alarm / robots, 1));
  std::vector<CheckedAngle> angles;
  for (const AoaMeasurement& aoa : mission.aoa_measurements) {
    const auto receiver = claim({aoa.receiver, {}, {}, Eigen::Vector3d::Zero()}, aoa.stamp);
    const auto transmitter = claim(aoa.transmitter, aoa.stamp);
    if (!receiver || !transmitter) continue;
    angles.push_back(checked(receiver->inverse() * *transmitter, aoa, mission, likelihood, params, band));
  }
  return IntegrityTest(mission, CheckedPose::kSelfReported, params, std::move(angles)).run();
}

template <class Pose>
AoaIntegrity check_estimate(const Mission& mission, const JointGraph<Pose>& joint,
                            const TeamAlignment<Pose>& alignment, const AoaLikelihoodParams& likelihood,
                            const AoaIntegrityParams& params) {
  const auto& poses = joint.team.graph.poses;
  KeyframePoses<Pose> of_team(joint, mission);
  std::vector<CheckedAngle> angles;
  for (std::size_t k = 0; k < joint.origins.bearings.size(); ++k) {
    const FactorOrigin& origin = joint.origins.bearings[k];
    const RobotIndex receiver = origin.robot_i, transmitter = origin.robot_j;
    if (!transmitter.valid() || !alignment.placed[receiver.index()] ||
        !alignment.placed[transmitter.index()] ||
        alignment.component[receiver.index()] != alignment.component[transmitter.index()])
      continue;
    const AoaMeasurement& aoa = mission.aoa_measurements[origin.measurement];
    const auto body = [&](RobotIndex robot) {
      const auto at = *of_team.at(robot, aoa.stamp);
      return poses[at.pose.index()] * at.motion.T_keyframe_body.pose;
    };
    const UncertainPose<Pose> T_r_t{body(receiver).inverse() * body(transmitter)};
    angles.push_back(checked(T_r_t, aoa, mission, likelihood, params, 0));
  }
  return IntegrityTest(mission, CheckedPose::kEstimate, params, std::move(angles)).run();
}

std::vector<std::string> angle_notes(const AoaIntegrity& checks, CheckedPose pose) {
  std::vector<std::string> notes;
  for (const auto& group : checks.suspects) {
    std::string who = group.front();
    for (std::size_t k = 1; k < group.size(); ++k) who += " or " + group[k];
    notes.push_back(
        pose == CheckedPose::kSelfReported
            ? "the angles of arrival contradict the pose of " + who +
                  " as reported by its known start and odometry: one of these is wrong"
            : "the angles of arrival contradict the pose of " + who +
                  " as estimated: its links are detours, or its odometry or the team alignment is wrong");
  }
  return notes;
}

#define RADIOSLAM_ANGLE_CHECKS(Pose)                                                                        \
  template AoaIntegrity check_self_reports<Pose>(const Mission&, const JointGraphParams&,                   \
                                                 const AoaLikelihoodParams&, const AoaIntegrityParams&);    \
  template AoaIntegrity check_estimate(const Mission&, const JointGraph<Pose>&, const TeamAlignment<Pose>&, \
                                       const AoaLikelihoodParams&, const AoaIntegrityParams&);
RADIOSLAM_ANGLE_CHECKS(SE2)
RADIOSLAM_ANGLE_CHECKS(SE3)
#undef RADIOSLAM_ANGLE_CHECKS

}  // namespace radioslam
