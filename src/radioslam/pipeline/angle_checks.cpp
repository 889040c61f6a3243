#include "radioslam/pipeline/angle_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/median.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/mission/odometry_between.hpp"
#include "radioslam/pipeline/angle_predictions.hpp"
#include "radioslam/pipeline/radio_factors.hpp"

namespace radioslam {
namespace {

/// Robots first, then anchors.
using Node = std::size_t;
using Pair = std::pair<Node, Node>;

Node node_of(const RadioEnd& end, const Mission& mission) {
  return end.robot.valid() ? end.robot.index() : mission.robots.size() + end.anchor.index();
}

const std::string& name_of(Node node, const Mission& mission) {
  const std::size_t robots = mission.robots.size();
  return node < robots ? mission.robots[node].id : mission.anchors[node - robots].id;
}

/// One measurement against one relative pose.
struct CheckedAngle {
  Node receiver = 0, transmitter = 0;
  Stamp stamp;
  AngleCheck check;
  double log_odds = 0;

  Pair pair() const { return std::minmax(receiver, transmitter); }
};
using Angles = std::vector<const CheckedAngle*>;

/// log of E, of angles in the order of time: the mean of the products up to each angle and from each angle
/// on.
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

/// The claims' part of the false alarms that is left for E; the other half is that of their odometry.
double evidence_share(CheckedPose pose) { return pose == CheckedPose::kClaim ? 0.5 : 1; }

/// Decides on all pairs and robots by the same rules.
class Judge {
 public:
  Judge(const Mission& mission, CheckedPose pose, const AngleCheckParams& params,
        std::vector<CheckedAngle> angles)
      : mission_(mission), pose_(pose), params_(params), angles_(std::move(angles)) {
    std::stable_sort(angles_.begin(), angles_.end(),
                     [](const CheckedAngle& a, const CheckedAngle& b) { return a.stamp < b.stamp; });
  }

  AngleChecks run() const {
    std::map<Pair, Angles> pairs, directed;
    for (const CheckedAngle& angle : angles_) {
      pairs[angle.pair()].push_back(&angle);
      directed[{angle.receiver, angle.transmitter}].push_back(&angle);
    }
    AngleChecks checks;
    for (const auto& [ends, angles] : directed) {
      const double evidence = log_evidence(pairs.at(std::minmax(ends.first, ends.second)));
      AngleCheckResult result = summary(angles);
      result.receiver = name_of(ends.first, mission_);
      result.transmitter = name_of(ends.second, mission_);
      result.chance = std::min(1.0, std::exp(-evidence));
      result.contradicted = evidence >= needed(pairs.size());
      checks.pairs.push_back(std::move(result));
    }
    checks.suspects = suspects();
    return checks;
  }

 private:
  /// log of the evidence that decides between so many.
  double needed(std::size_t judged) const {
    return std::log(static_cast<double>(judged) / (evidence_share(pose_) * params_.false_alarm_probability));
  }

  AngleCheckResult summary(const Angles& angles) const {
    AngleCheckResult result;
    result.pose = pose_;
    result.measurements = angles.size();
    std::vector<double> weights;
    std::size_t beyond = 0;
    for (const CheckedAngle* angle : angles) {
      weights.push_back(angle->check.weight);
      beyond += angle->check.verdict == AngleVerdict::kBeyond ? 1U : 0U;
    }
    result.median_weight = upper_median(std::move(weights));
    result.share_beyond = static_cast<double>(beyond) / static_cast<double>(angles.size());
    return result;
  }

  /// log E of every robot, by the angles in which none of the `cleared` takes part.
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
  AngleCheckParams params_;
  std::vector<CheckedAngle> angles_;
};

/// The measurement against the relative pose; `band_sigmas` times what the pose's error turns the direction
/// by counts as hit.
template <class Pose>
CheckedAngle checked(const UncertainPose<Pose>& T_receiver_transmitter, const ArrivalMeasurement& arrival,
                     const Mission& mission, const ArrivalLikelihoodParams& likelihood,
                     const AngleCheckParams& params, double band_sigmas) {
  const SE3 T_start_receiver = *mission.robots[arrival.receiver.index()].odometry.at(arrival.stamp);
  const double band_rad = band_sigmas * direction_sigma(T_receiver_transmitter).azimuth_rad;
  return {arrival.receiver.index(), node_of(arrival.transmitter, mission), arrival.stamp,
          check_angles(T_receiver_transmitter, arrival, mission, likelihood),
          log_odds_elsewhere(as_se3(T_receiver_transmitter.pose, 0),
                             as_estimated<Pose>(arrival, T_start_receiver), params.direct_probability,
                             band_rad, likelihood)};
}

bool covers(const Mission& mission, RobotIndex robot, Stamp stamp) {
  return mission.robots[robot.index()].odometry.covers(stamp);
}

/// What a robot says of itself, when angles are measured.
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
  for (const ArrivalMeasurement& arrival : mission.arrivals)
    if ((arrival.receiver == robot || arrival.transmitter.robot == robot) &&
        covers(mission, robot, arrival.stamp))
      stamps.insert(arrival.stamp);
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
AngleChecks check_claims(const Mission& mission, const JointGraphParams& graph,
                         const ArrivalLikelihoodParams& likelihood, const AngleCheckParams& params) {
  std::vector<Claims<Pose>> claims;
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    claims.push_back(claims_of<Pose>(RobotIndex(r), mission, graph));
  const auto claim = [&](const RadioEnd& end, Stamp stamp) -> std::optional<UncertainPose<Pose>> {
    if (!end.robot.valid()) return claim_of_anchor<Pose>(mission.anchors[end.anchor.index()]);
    const auto& of_robot = claims[end.robot.index()];
    const auto found = of_robot.find(stamp);
    return found == of_robot.end() ? std::nullopt : std::optional(found->second);
  };
  const double false_alarm = (1 - evidence_share(CheckedPose::kClaim)) * params.false_alarm_probability;
  const auto robots = static_cast<double>(std::max<std::size_t>(mission.robots.size(), 1));
  const double band = params.odometry_margin * std::sqrt(chi_squared_quantile(1 - false_alarm / robots, 1));
  std::vector<CheckedAngle> angles;
  for (const ArrivalMeasurement& arrival : mission.arrivals) {
    const auto receiver = claim({arrival.receiver, {}, {}, Eigen::Vector3d::Zero()}, arrival.stamp);
    const auto transmitter = claim(arrival.transmitter, arrival.stamp);
    if (!receiver || !transmitter) continue;
    angles.push_back(checked(receiver->inverse() * *transmitter, arrival, mission, likelihood, params, band));
  }
  return Judge(mission, CheckedPose::kClaim, params, std::move(angles)).run();
}

template <class Pose>
AngleChecks check_estimate(const Mission& mission, const JointGraph<Pose>& joint,
                           const TeamPlacement<Pose>& placement, const ArrivalLikelihoodParams& likelihood,
                           const AngleCheckParams& params) {
  const auto& graph = joint.team.graph;
  std::vector<CheckedAngle> angles;
  std::size_t bearing = 0;  // the joint graph has one for each measurement within the odometry
  for (const ArrivalMeasurement& arrival : mission.arrivals) {
    const RobotIndex receiver = arrival.receiver, transmitter = arrival.transmitter.robot;
    const bool in_graph = covers(mission, receiver, arrival.stamp) &&
                          (!transmitter.valid() || covers(mission, transmitter, arrival.stamp));
    if (!in_graph || bearing >= joint.team.bearings.size()) continue;
    const auto& ends = joint.team.bearings[bearing++];
    if (!transmitter.valid() || !placement.placed[receiver.index()] ||
        !placement.placed[transmitter.index()] ||
        placement.component[receiver.index()] != placement.component[transmitter.index()])
      continue;
    const UncertainPose<Pose> T_r_t{graph.poses[ends.i.index()].inverse() * graph.poses[ends.j.pose.index()]};
    angles.push_back(checked(T_r_t, arrival, mission, likelihood, params, 0));
  }
  return Judge(mission, CheckedPose::kEstimate, params, std::move(angles)).run();
}

std::vector<std::string> angle_notes(const AngleChecks& checks, CheckedPose pose) {
  std::vector<std::string> notes;
  for (const auto& group : checks.suspects) {
    std::string who = group.front();
    for (std::size_t k = 1; k < group.size(); ++k) who += " or " + group[k];
    notes.push_back(
        pose == CheckedPose::kClaim
            ? "the angles of arrival contradict where " + who +
                  " says it was: its known start or its odometry is wrong"
            : "the angles of arrival contradict where " + who +
                  " is estimated to have been: its odometry is wrong, or the team is laid out wrongly");
  }
  return notes;
}

#define RADIOSLAM_ANGLE_CHECKS(Pose)                                                                       \
  template AngleChecks check_claims<Pose>(const Mission&, const JointGraphParams&,                         \
                                          const ArrivalLikelihoodParams&, const AngleCheckParams&);        \
  template AngleChecks check_estimate(const Mission&, const JointGraph<Pose>&, const TeamPlacement<Pose>&, \
                                      const ArrivalLikelihoodParams&, const AngleCheckParams&);
RADIOSLAM_ANGLE_CHECKS(SE2)
RADIOSLAM_ANGLE_CHECKS(SE3)
#undef RADIOSLAM_ANGLE_CHECKS

}  // namespace radioslam
