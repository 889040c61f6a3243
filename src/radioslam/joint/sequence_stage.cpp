#include "radioslam/joint/sequence_stage.hpp"

#include <Eigen/LU>
#include <string>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// The keyframe before a fingerprint.
std::size_t keyframe_of_node(const RobotVariables& robot, const RadioMeasurements& radio, std::size_t node) {
  return keyframe_before(robot.stamps, radio.at(node).fingerprint.stamp);
}

template <class Pose>
const RobotVariables& robot_of_node(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                    std::size_t node) {
  return joint.robots[radio.nodes[node].robot.index()];
}

template <class Pose>
Stamp stamp_of_node(const JointGraph<Pose>& joint, const RadioMeasurements& radio, std::size_t node) {
  return keyframe_stamp(joint, radio.nodes[node].robot, radio.at(node).fingerprint.stamp);
}

/// The closure moved to keyframes, T_l_k = T_l_j T_j_i T_i_k, over the odometry to either fingerprint.
RelativePoseFactor<SE2> keyframe_factor(const JointGraph<SE2>& joint, const RadioMeasurements& radio,
                                        const SequenceClosure& closure, double loss_sigmas) {
  const auto [node_i, node_j, similarity] = closure.candidate;
  const RobotVariables &robot_i = robot_of_node(joint, radio, node_i),
                       &robot_j = robot_of_node(joint, radio, node_j);
  const std::size_t k = keyframe_of_node(robot_i, radio, node_i);
  const std::size_t l = keyframe_of_node(robot_j, radio, node_j);
  const UncertainPose<SE2> T_l_j{flatten(robot_j.odometry[l].inverse() * radio.at(node_j).T_start_body)};
  const UncertainPose<SE2> T_i_k{flatten(radio.at(node_i).T_start_body.inverse() * robot_i.odometry[k])};
  const auto T_l_k = T_l_j * UncertainPose<SE2>{closure.fit.T_j_i, closure.fit.covariance} * T_i_k;
  RelativePoseFactor<SE2> factor;
  factor.i = robot_j.poses[l];
  factor.j = robot_i.poses[k];
  factor.T_i_j = T_l_k.pose;
  factor.information = inverse(T_l_k.covariance);
  factor.loss = {LossKind::kCauchy, loss_sigmas};
  return factor;
}

}  // namespace

std::optional<std::string> sequence_note(int dimension, const RadioMeasurements& radio,
                                         const SequenceStageParams& params) {
  if (dimension == 2 || !params.enabled || radio.nodes.empty()) return std::nullopt;
  return "sequence closures were skipped: they are poses in the plane, and the mission has three dimensions";
}

template <class Pose>
std::vector<SequenceClosure> add_sequence_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                                   const SequenceStageParams& params) {
  std::vector<SequenceClosure> closures;
  if constexpr (Pose::kDim == 2) {
    if (!params.enabled) return closures;
    closures = propose_sequence_closures(radio, params.closure);
    for (std::size_t k = 0; k < closures.size(); ++k) {
      if (closures[k].fit.status != SequenceStatus::kAccepted) continue;
      const auto [i, j, similarity] = closures[k].candidate;
      add_factor(joint, keyframe_factor(joint, radio, closures[k], params.loss_sigmas),
                 {FactorSource::kSequence, k, radio.nodes[i].robot, radio.nodes[j].robot,
                  stamp_of_node(joint, radio, i), stamp_of_node(joint, radio, j)});
    }
  }
  return closures;
}

template <class Pose>
std::vector<ClosureResult> collect_sequence_closures(const JointGraph<Pose>& joint,
                                                     const RadioMeasurements& radio,
                                                     const std::vector<SequenceClosure>& closures) {
  const auto factors =
      factors_by_measurement(joint.origins.relative_poses, FactorSource::kSequence, closures.size());
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto& [candidate, fit] = closures[k];
    const auto [i, j, similarity] = candidate;
    ClosureResult result{radio.nodes[i].robot,   stamp_of_node(joint, radio, i),
                         radio.nodes[j].robot,   stamp_of_node(joint, radio, j),
                         ClosureKind::kSequence, ClosureStatus::kRejected,
                         fit.residual_m,         std::string(reason(fit.status))};
    if (factors[k]) {
      const auto& graph = joint.team.graph;
      if (squared_norm(graph, graph.relative_poses[*factors[k]]) > kPoseChiSquared99<SE2>)
        result.reason = "the estimate disagrees";
      else
        result.status = ClosureStatus::kAccepted;
    }
    results.push_back(std::move(result));
  }
  return results;
}

#define RADIOSLAM_SEQUENCE_STAGE(Pose)                                                                     \
  template std::vector<SequenceClosure> add_sequence_closures(JointGraph<Pose>&, const RadioMeasurements&, \
                                                              const SequenceStageParams&);                 \
  template std::vector<ClosureResult> collect_sequence_closures(                                           \
      const JointGraph<Pose>&, const RadioMeasurements&, const std::vector<SequenceClosure>&);
RADIOSLAM_SEQUENCE_STAGE(SE2)
RADIOSLAM_SEQUENCE_STAGE(SE3)
#undef RADIOSLAM_SEQUENCE_STAGE

}  // namespace radioslam
