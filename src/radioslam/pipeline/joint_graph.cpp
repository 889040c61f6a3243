#include "radioslam/pipeline/joint_graph.hpp"

#include <algorithm>

#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/pipeline/radio_factors.hpp"
#include "radioslam/pipeline/robot_nodes.hpp"

namespace radioslam {
namespace {

constexpr double kLeastSigmaDistance_m = 1;  // a predicted distance is never better than that
constexpr double kSigmaLevel_rad = 0.03;     // roll and pitch of a start frame, which gravity gives

double information(double sigma) { return 1 / (sigma * sigma); }

/// A constant drift is a variable where something is stated about it, or where fingerprints or fixes can
/// tell.
template <class Pose>
DriftId add_drift(PoseGraph<Pose>& graph, const Robot& robot, const JointGraphParams& params) {
  const OdometryNoise& noise = robot.odometry_noise;
  const double floor = robot.wifi.empty() && robot.fixes.empty() ? 0 : 1;
  const double yaw =
      std::max(noise.sigma_yaw_drift_per_m_rad, floor * params.least_sigma_yaw_drift_per_m_rad);
  const double scale = std::max(noise.sigma_scale, floor * params.least_sigma_scale);
  if (yaw <= 0 && scale <= 0) return {};
  constexpr double kAsGoodAsNone = 1e-9;
  DriftPriorFactor prior;
  prior.i = DriftId(graph.drifts.size());
  prior.information =
      Eigen::Vector2d(information(std::max(yaw, kAsGoodAsNone)), information(std::max(scale, kAsGoodAsNone)))
          .asDiagonal();
  graph.drifts.emplace_back(Drift::Zero());
  graph.drift_priors.push_back(prior);
  return prior.i;
}

template <class Pose>
Piece add_odometry(PoseGraph<Pose>& graph, const Robot& robot, const RobotNodes& nodes, DriftId drift) {
  Piece piece{robot.id,
              graph.poses.size(),
              nodes.rows.size(),
              nodes.stamps,
              robot.heading == Heading::kAbsolute ? robot.sigma_heading_rad : 0,
              robot.initial_pose.has_value()};
  const Pose T_frame_start = pose_as<Pose>(common_from_start(robot).value_or(SE3()));
  for (std::size_t n = 0; n < nodes.rows.size(); ++n) {
    graph.poses.push_back(T_frame_start * pose_as<Pose>(nodes.odometry[nodes.rows[n]].pose));
    if (n == 0) continue;
    const auto edge =
        odometry_edge<Pose>(nodes.odometry, nodes.rows[n - 1], nodes.rows[n], robot.odometry_noise);
    RelativePoseFactor<Pose> factor;
    factor.i = PoseId(piece.first_pose + n - 1);
    factor.j = PoseId(piece.first_pose + n);
    factor.T_i_j = edge.T_i_j;
    factor.information = edge.covariance.inverse();
    factor.drift = drift;
    factor.drift_jacobian = -edge.drift_jacobian;  // the odometry holds the drift, the true motion does not
    graph.relative_poses.push_back(factor);
  }
  return piece;
}

JointRobot joint_robot(const Robot& robot, const RobotNodes& nodes, std::size_t first_pose, DriftId drift) {
  JointRobot result;
  result.id = robot.id;
  for (const std::size_t n : nodes.keyframes) {
    result.stamps.push_back(nodes.stamps[n]);
    result.poses.push_back(PoseId(first_pose + n));
    result.odometry.push_back(nodes.odometry[nodes.rows[n]].pose);
  }
  result.drift = drift;
  result.T_common_start = common_from_start(robot);
  result.lidar_range_m = robot.lidar_range_m;
  result.lidar_view_rad = robot.lidar_view_rad;
  return result;
}

/// What is known of a robot's first pose: everything (a known start), its heading, that it stands level.
template <class Pose>
void add_start_prior(PoseGraph<Pose>& graph, const Robot& robot, std::size_t first_pose,
                     const JointGraphParams& params) {
  constexpr int kRotations = Pose::kDof - Pose::kDim;
  PosePriorFactor<Pose> prior;
  prior.i = PoseId(first_pose);
  prior.prior = graph.poses[first_pose];
  prior.information.setZero();
  auto diagonal = prior.information.diagonal();
  if (robot.initial_pose) {
    diagonal.setConstant(information(params.sigma_start_m));
    diagonal.template tail<kRotations>().setConstant(information(params.sigma_start_rad));
  } else {
    if constexpr (kRotations == 3)
      diagonal.template segment<2>(Pose::kDim).setConstant(information(kSigmaLevel_rad));
    if (robot.heading == Heading::kAbsolute) diagonal[Pose::kDof - 1] = information(robot.sigma_heading_rad);
  }
  if (!prior.information.isZero(0)) graph.pose_priors.push_back(prior);
}

/// Odometry of scans is good to centimetres: its keyframes follow its bends.
KeyframeParams keyframe_rule(const Robot& robot, KeyframeParams params) {
  if (robot.lidar.empty()) params.bend_m = params.bend_rad = 0;
  return params;
}

}  // namespace

std::optional<SE3> common_from_start(const Robot& robot) {
  if (!robot.initial_pose) return std::nullopt;
  return lift(flatten(*robot.initial_pose),
              robot.initial_pose->translation().z() - robot.odometry.front().pose.translation().z());
}

template <class Pose>
JointGraph<Pose> build_joint_graph(const Mission& mission, const KeyframeParams& keyframes,
                                   const JointGraphParams& params, std::vector<std::vector<Stamp>> moments) {
  JointGraph<Pose> joint;
  moments.resize(mission.robots.size());
  add_link_moments(mission, moments);
  std::vector<RobotNodes> nodes;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    nodes.push_back(select_nodes(robot.odometry, moments[r], keyframe_rule(robot, keyframes)));
    const DriftId drift = add_drift(joint.team.graph, robot, params);
    joint.team.pieces.push_back(add_odometry(joint.team.graph, robot, nodes.back(), drift));
    const std::size_t first_pose = joint.team.pieces.back().first_pose;
    joint.robots.push_back(joint_robot(robot, nodes.back(), first_pose, drift));
    joint.robot_of_piece.push_back(r);
    add_start_prior(joint.team.graph, robot, first_pose, params);
  }
  add_radio_factors(joint, mission, nodes);
  joint.first_closure_range = joint.team.graph.ranges.size();
  return joint;
}

template <class Pose>
void place_robots(JointGraph<Pose>& joint, const std::vector<SE2>& T_team_start) {
  for (std::size_t p = 0; p < joint.team.pieces.size(); ++p) {
    const Piece& piece = joint.team.pieces[p];
    if (piece.in_common_frame) continue;
    move_piece(joint.team.graph.poses, piece, pose_as<Pose>(lift(T_team_start[joint.robot_of_piece[p]])));
  }
}

template <class Pose>
PoseId pose_at(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp) {
  for (std::size_t p = 0; p < joint.team.pieces.size(); ++p) {
    if (joint.robot_of_piece[p] != robot.index()) continue;
    const Piece& piece = joint.team.pieces[p];
    const auto found = std::lower_bound(piece.stamps.begin(), piece.stamps.end(), stamp);
    if (found != piece.stamps.end() && *found == stamp)
      return PoseId(piece.first_pose + static_cast<std::size_t>(found - piece.stamps.begin()));
  }
  return {};
}

template <class Pose>
RangeEnd<Pose> fingerprint_end(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                               std::size_t node) {
  const std::size_t robot = radio.nodes[node].robot.index();
  const JointRobot& of = joint.robots[robot];
  const PlacedFingerprint& placed = radio.at(node);
  const std::size_t k = keyframe_before(of.stamps, placed.fingerprint.stamp);
  RangeEnd<Pose> end;
  end.pose = of.poses[k];
  end.lever_arm =
      (pose_as<Pose>(of.odometry[k]).inverse() * pose_as<Pose>(placed.T_start_body)).translation();
  return end;
}

/// The odometry in whose metres a near pair's distance is told: similarities were learned from all robots'
/// own odometries together, so that the pairs of two robots take one's and the other's in turn.
template <class Pose>
DriftId taught_by(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                  const FingerprintClosure& closure) {
  const std::size_t node = (closure.node_i + closure.node_j) % 2 == 0 ? closure.node_i : closure.node_j;
  return joint.robots[radio.nodes[node].robot.index()].drift;
}

template <class Pose>
void add_fingerprint_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                              const std::vector<FingerprintClosure>& closures) {
  for (const FingerprintClosure& closure : closures) {
    RangeFactor<Pose> range;
    range.i = fingerprint_end(joint, radio, closure.node_i);
    range.j = fingerprint_end(joint, radio, closure.node_j);
    range.range_m = closure.predicted.peak_m;
    range.sigma_m = std::max(kLeastSigmaDistance_m, closure.predicted.spread_m);
    range.weight = closure.weight;
    if (!closure.holds_layout) range.drift = taught_by(joint, radio, closure);
    joint.team.graph.ranges.push_back(range);
  }
}

#define RADIOSLAM_JOINT_GRAPH(Pose)                                                                        \
  template JointGraph<Pose> build_joint_graph<Pose>(                                                       \
      const Mission&, const KeyframeParams&, const JointGraphParams&, std::vector<std::vector<Stamp>>);    \
  template PoseId pose_at(const JointGraph<Pose>&, RobotIndex, Stamp);                                     \
  template void place_robots(JointGraph<Pose>&, const std::vector<SE2>&);                                  \
  template RangeEnd<Pose> fingerprint_end(const JointGraph<Pose>&, const RadioMeasurements&, std::size_t); \
  template void add_fingerprint_closures(JointGraph<Pose>&, const RadioMeasurements&,                      \
                                         const std::vector<FingerprintClosure>&);
RADIOSLAM_JOINT_GRAPH(SE2)
RADIOSLAM_JOINT_GRAPH(SE3)
#undef RADIOSLAM_JOINT_GRAPH

}  // namespace radioslam
