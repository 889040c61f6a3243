#include "radioslam/joint/joint_graph.hpp"

#include <algorithm>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/level_priors.hpp"
#include "radioslam/joint/links/radio_factors.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {

std::vector<std::size_t> factors_of(const std::vector<FactorOrigin>& origins, FactorSource source) {
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < origins.size(); ++k)
    if (origins[k].source == source) indices.push_back(k);
  return indices;
}

namespace {

constexpr double kMinSigmaDistance_m = 1;  // lower bound on the error of a predicted distance

double information(double sigma) { return 1 / (sigma * sigma); }

/// Adds constant drift as a variable where its noise is given, or where fingerprints or fixes make it
/// observable.
template <class Pose>
DriftId add_drift(PoseGraph<Pose>& graph, const Robot& robot, const JointGraphParams& params) {
  const OdometryNoise& noise = robot.odometry_noise;
  const double floor = robot.wifi.empty() && robot.fixes.empty() ? 0 : 1;
  const double yaw = std::max(noise.sigma_yaw_drift_per_m_rad, floor * params.min_sigma_yaw_drift_per_m_rad);
  const double scale = std::max(noise.sigma_scale, floor * params.min_sigma_scale);
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

/// Adds the motion between the robot's keyframes, which are the poses from `first_pose` on.
template <class Pose>
void add_odometry(JointGraph<Pose>& joint, RobotIndex index, const Robot& robot, const RobotNodes& nodes,
                  std::size_t first_pose, DriftId drift) {
  for (std::size_t n = 1; n < nodes.rows.size(); ++n) {
    const auto edge =
        odometry_edge<Pose>(nodes.odometry, nodes.rows[n - 1], nodes.rows[n], robot.odometry_noise);
    RelativePoseFactor<Pose> factor;
    factor.i = PoseId(first_pose + n - 1);
    factor.j = PoseId(first_pose + n);
    factor.T_i_j = edge.T_i_j;
    factor.information = inverse(edge.covariance);
    factor.drift = drift;
    factor.drift_jacobian =
        -edge.drift_jacobian;  // the odometry contains the drift, the true motion does not
    add_factor(joint, factor,
               {FactorSource::kOdometry, n - 1, index, index, nodes.stamps[n - 1], nodes.stamps[n]});
  }
}

template <class Pose>
TrajectorySegment add_trajectory(JointGraph<Pose>& joint, RobotIndex index, const Robot& robot,
                                 const RobotNodes& nodes, DriftId drift) {
  PoseGraph<Pose>& graph = joint.team.graph;
  TrajectorySegment segment{robot.id,
                            graph.poses.size(),
                            nodes.rows.size(),
                            nodes.stamps,
                            robot.heading == Heading::kAbsolute ? robot.sigma_heading_rad : 0,
                            robot.initial_pose.has_value()};
  const Pose T_frame_start = pose_as<Pose>(common_from_start(robot).value_or(SE3()));
  for (const std::size_t row : nodes.rows)
    graph.poses.push_back(T_frame_start * pose_as<Pose>(nodes.odometry[row].pose));
  add_odometry(joint, index, robot, nodes, segment.first_pose, drift);
  return segment;
}

RobotVariables joint_robot(const Robot& robot, const RobotNodes& nodes, std::size_t first_pose,
                           DriftId drift) {
  RobotVariables result;
  result.id = robot.id;
  result.stamps = nodes.stamps;
  for (std::size_t n = 0; n < nodes.rows.size(); ++n) {
    result.poses.push_back(PoseId(first_pose + n));
    result.odometry.push_back(nodes.odometry[nodes.rows[n]].pose);
  }
  result.drift = drift;
  result.T_common_start = common_from_start(robot);
  result.lidar_range_m = robot.lidar_range_m;
  result.lidar_view_rad = robot.lidar_view_rad;
  return result;
}

/// Prior on a robot's first pose: the whole pose if its start is known, or its absolute heading.
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
  } else if (robot.heading == Heading::kAbsolute) {
    diagonal[Pose::kDof - 1] = information(robot.sigma_heading_rad);
  }
  if (!prior.information.isZero(0)) graph.pose_priors.push_back(prior);
}

}  // namespace

std::optional<SE3> common_from_start(const Robot& robot) {
  if (!robot.initial_pose) return std::nullopt;
  return lift(flatten(*robot.initial_pose),
              robot.initial_pose->translation().z() - robot.odometry.front().pose.translation().z());
}

template <class Pose>
JointGraph<Pose> build_joint_graph(const Mission& mission, const KeyframeParams& keyframes,
                                   const JointGraphParams& params) {
  JointGraph<Pose> joint;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    const RobotNodes nodes = nodes_at(robot.odometry, keyframes_of(mission, RobotIndex(r), keyframes));
    const DriftId drift = add_drift(joint.team.graph, robot, params);
    joint.team.segments.push_back(add_trajectory(joint, RobotIndex(r), robot, nodes, drift));
    const std::size_t first_pose = joint.team.segments.back().first_pose;
    joint.robots.push_back(joint_robot(robot, nodes, first_pose, drift));
    joint.robot_of_segment.push_back(r);
    add_start_prior(joint.team.graph, robot, first_pose, params);
    add_level_priors(joint.team.graph, robot, nodes, first_pose, params.sigma_level_rad);
  }
  add_radio_factors(joint, mission);
  return joint;
}

template <class Pose>
void place_robots(JointGraph<Pose>& joint, const std::vector<SE2>& T_team_start) {
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const TrajectorySegment& segment = joint.team.segments[p];
    if (segment.in_common_frame) continue;
    move_segment(joint.team.graph.poses, segment,
                 pose_as<Pose>(lift(T_team_start[joint.robot_of_segment[p]])));
  }
}

template <class Pose>
PoseId pose_at(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp) {
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    if (joint.robot_of_segment[p] != robot.index()) continue;
    const TrajectorySegment& segment = joint.team.segments[p];
    const auto found = std::lower_bound(segment.stamps.begin(), segment.stamps.end(), stamp);
    if (found != segment.stamps.end() && *found == stamp)
      return PoseId(segment.first_pose + static_cast<std::size_t>(found - segment.stamps.begin()));
  }
  return {};
}

namespace {

/// Position of fingerprint `node` of `radio`: a lever arm on the keyframe before it.
template <class Pose>
RangeEnd<Pose> fingerprint_anchor(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                  std::size_t node) {
  const std::size_t robot = radio.nodes[node].robot.index();
  const RobotVariables& of = joint.robots[robot];
  const PlacedFingerprint& placed = radio.at(node);
  const std::size_t k = keyframe_before(of.stamps, placed.fingerprint.stamp);
  RangeEnd<Pose> end;
  end.pose = of.poses[k];
  end.lever_arm =
      (pose_as<Pose>(of.odometry[k]).inverse() * pose_as<Pose>(placed.T_start_body)).translation();
  return end;
}

/// The drift variable whose scale the predicted distance of a close pair follows. Distances were learnt from
/// the odometry of all robots together, so pairs alternate between their two robots.
template <class Pose>
DriftId scale_source(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                     const FingerprintClosure& closure) {
  const std::size_t node = (closure.node_i + closure.node_j) % 2 == 0 ? closure.node_i : closure.node_j;
  return joint.robots[radio.nodes[node].robot.index()].drift;
}

}  // namespace

template <class Pose>
Eigen::Matrix3Xd fingerprint_places(const JointGraph<Pose>& joint, const RadioMeasurements& radio) {
  Eigen::Matrix3Xd places = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(radio.nodes.size()));
  for (std::size_t node = 0; node < radio.nodes.size(); ++node) {
    const RangeEnd<Pose> anchor = fingerprint_anchor(joint, radio, node);
    places.col(static_cast<Eigen::Index>(node)).template head<Pose::Point::RowsAtCompileTime>() =
        joint.team.graph.poses[anchor.pose.index()] * anchor.lever_arm;
  }
  return places;
}

template <class Pose>
void add_fingerprint_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                              const std::vector<FingerprintClosure>& closures) {
  const auto keyframe = [&](std::size_t node) {
    return keyframe_stamp(joint, radio.nodes[node].robot, radio.at(node).fingerprint.stamp);
  };
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const FingerprintClosure& closure = closures[k];
    RangeFactor<Pose> range;
    range.i = fingerprint_anchor(joint, radio, closure.node_i);
    range.j = fingerprint_anchor(joint, radio, closure.node_j);
    range.range_m = closure.predicted.peak_m;
    range.sigma_m = std::max(kMinSigmaDistance_m, closure.predicted.spread_m);
    range.weight = closure.weight;
    if (!closure.keeps_layout) range.drift = scale_source(joint, radio, closure);
    add_factor(joint, range,
               {FactorSource::kFingerprint, k, radio.nodes[closure.node_i].robot,
                radio.nodes[closure.node_j].robot, keyframe(closure.node_i), keyframe(closure.node_j)});
  }
}

#define RADIOSLAM_JOINT_GRAPH(Pose)                                                                \
  template JointGraph<Pose> build_joint_graph<Pose>(const Mission&, const KeyframeParams&,         \
                                                    const JointGraphParams&);                      \
  template PoseId pose_at(const JointGraph<Pose>&, RobotIndex, Stamp);                             \
  template void place_robots(JointGraph<Pose>&, const std::vector<SE2>&);                          \
  template Eigen::Matrix3Xd fingerprint_places(const JointGraph<Pose>&, const RadioMeasurements&); \
  template void add_fingerprint_closures(JointGraph<Pose>&, const RadioMeasurements&,              \
                                         const std::vector<FingerprintClosure>&);
RADIOSLAM_JOINT_GRAPH(SE2)
RADIOSLAM_JOINT_GRAPH(SE3)
#undef RADIOSLAM_JOINT_GRAPH

}  // namespace radioslam
