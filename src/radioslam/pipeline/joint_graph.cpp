#include "radioslam/pipeline/joint_graph.hpp"

#include <algorithm>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

constexpr double kSigmaAnchor_m = 1e-3;  // the frame's own origin is known by definition
constexpr double kSigmaAnchor_rad = 1e-4;
constexpr double kLeastSigmaDistance_m = 1;  // a predicted distance is never better than that

double information(double sigma) { return 1 / (sigma * sigma); }

/// T_team_start with the start's own height, roll and pitch.
template <class Pose>
Pose team_from_start(const SE2& T_team_start, const Robot& robot) {
  const double z = robot.initial_pose
                       ? robot.initial_pose->translation().z() - robot.odometry.front().pose.translation().z()
                       : 0;
  return pose_as<Pose>(lift(T_team_start, z));
}

template <class Pose>
void add_odometry(JointGraph<Pose>& joint, const Robot& robot, const Pose& T_team_start,
                  const KeyframeParams& params, DriftId drift) {
  RobotVariables variables;
  variables.rows = select_keyframes(robot.odometry, params);
  variables.first_pose = joint.graph.poses.size();
  for (std::size_t k = 0; k < variables.rows.size(); ++k) {
    const auto& [stamp, pose] = robot.odometry[variables.rows[k]];
    variables.stamps.push_back(stamp);
    joint.graph.poses.push_back(T_team_start * pose_as<Pose>(pose));
    if (k == 0) continue;
    const auto edge =
        odometry_edge<Pose>(robot.odometry, variables.rows[k - 1], variables.rows[k], robot.odometry_noise);
    RelativePoseFactor<Pose> factor;
    factor.i = PoseId(variables.first_pose + k - 1);
    factor.j = PoseId(variables.first_pose + k);
    factor.T_i_j = edge.T_i_j;
    factor.information = edge.covariance.inverse();
    factor.drift = drift;
    factor.drift_jacobian = -edge.drift_jacobian;  // the odometry holds the drift, the true motion does not
    joint.graph.relative_poses.push_back(factor);
  }
  joint.robots.push_back(std::move(variables));
}

template <class Pose>
void add_drift_prior(PoseGraph<Pose>& graph, const OdometryNoise& noise, const JointGraphParams& params) {
  DriftPriorFactor prior;
  prior.i = DriftId(graph.drifts.size());
  const double yaw = std::max(noise.sigma_yaw_drift_per_m_rad, params.least_sigma_yaw_drift_per_m_rad);
  const double scale = std::max(noise.sigma_scale, params.least_sigma_scale);
  prior.information = Eigen::Vector2d(information(yaw), information(scale)).asDiagonal();
  graph.drifts.emplace_back(Drift::Zero());
  graph.drift_priors.push_back(prior);
}

/// What is known of a robot's first pose: everything (a known start, the first robot of a component, which
/// gives the frame), the heading alone, or nothing.
template <class Pose>
void add_start_prior(JointGraph<Pose>& joint, const Robot& robot, const JointGraphParams& params,
                     bool gives_frame) {
  constexpr int kRotations = Pose::kDof - Pose::kDim;
  const bool has_heading = robot.heading == Heading::kAbsolute;
  if (!robot.initial_pose && !gives_frame && !has_heading) return;
  PosePriorFactor<Pose> prior;
  prior.i = PoseId(joint.robots.back().first_pose);
  prior.prior = joint.graph.poses[prior.i.index()];
  prior.information.setZero();
  auto diagonal = prior.information.diagonal();
  if (robot.initial_pose) {
    diagonal.setConstant(information(params.sigma_start_m));
    diagonal.template tail<kRotations>().setConstant(information(params.sigma_start_rad));
  } else {
    if (gives_frame) diagonal.setConstant(information(kSigmaAnchor_m));
    if (gives_frame) diagonal.template tail<kRotations>().setConstant(information(kSigmaAnchor_rad));
    if (has_heading) diagonal[Pose::kDof - 1] = information(robot.sigma_heading_rad);
  }
  joint.graph.pose_priors.push_back(prior);
}

template <class Pose>
RangeEnd<Pose> fingerprint_end(const JointGraph<Pose>& joint, const Mission& mission,
                               const RadioMeasurements& radio, std::size_t node) {
  const std::size_t robot = radio.nodes[node].robot.index();
  const RobotVariables& variables = joint.robots[robot];
  const PlacedFingerprint& placed = radio.at(node);
  const std::size_t k = keyframe_before(variables.stamps, placed.fingerprint.stamp);
  const Pose T_start_keyframe = pose_as<Pose>(mission.robots[robot].odometry[variables.rows[k]].pose);
  RangeEnd<Pose> end;
  end.pose = PoseId(variables.first_pose + k);
  end.lever_arm = (T_start_keyframe.inverse() * pose_as<Pose>(placed.T_start_body)).translation();
  return end;
}

}  // namespace

template <class Pose>
JointGraph<Pose> build_joint_graph(const Mission& mission, const KeyframeParams& keyframes,
                                   const RadioMeasurements& radio, const TeamFrame& team_frame,
                                   const std::vector<FingerprintClosure>& closures,
                                   const JointGraphParams& params) {
  JointGraph<Pose> joint;
  std::vector<bool> has_frame(mission.robots.size(), false);  // per component
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (mission.robots[r].initial_pose) has_frame[static_cast<std::size_t>(team_frame.component[r])] = true;

  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    const auto component = static_cast<std::size_t>(team_frame.component[r]);
    add_odometry(joint, robot, team_from_start<Pose>(team_frame.T_team_start[r], robot), keyframes,
                 DriftId(joint.graph.drifts.size()));
    add_drift_prior(joint.graph, robot.odometry_noise, params);
    add_start_prior(joint, robot, params, !has_frame[component]);
    has_frame[component] = true;
  }
  joint.first_closure_range = joint.graph.ranges.size();
  for (const FingerprintClosure& closure : closures) {
    RangeFactor<Pose> range;
    range.i = fingerprint_end(joint, mission, radio, closure.node_i);
    range.j = fingerprint_end(joint, mission, radio, closure.node_j);
    range.range_m = closure.predicted.peak_m;
    range.sigma_m = std::max(kLeastSigmaDistance_m, closure.predicted.spread_m);
    range.weight = closure.weight;
    joint.graph.ranges.push_back(range);
  }
  return joint;
}

template JointGraph<SE2> build_joint_graph<SE2>(const Mission&, const KeyframeParams&,
                                                const RadioMeasurements&, const TeamFrame&,
                                                const std::vector<FingerprintClosure>&,
                                                const JointGraphParams&);
template JointGraph<SE3> build_joint_graph<SE3>(const Mission&, const KeyframeParams&,
                                                const RadioMeasurements&, const TeamFrame&,
                                                const std::vector<FingerprintClosure>&,
                                                const JointGraphParams&);

}  // namespace radioslam
