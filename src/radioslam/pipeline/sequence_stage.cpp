#include "radioslam/pipeline/sequence_stage.hpp"

#include <Eigen/LU>
#include <string>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// The keyframe before a fingerprint.
std::size_t keyframe_of_node(const JointRobot& robot, const RadioMeasurements& radio, std::size_t node) {
  return keyframe_before(robot.stamps, radio.at(node).fingerprint.stamp);
}

template <class Pose>
const JointRobot& robot_of_node(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                std::size_t node) {
  return joint.robots[radio.nodes[node].robot.index()];
}

/// The closure between keyframes: T_l_k = T_l_j T_j_i T_i_k, over the few metres to either fingerprint.
RelativePoseFactor<SE2> keyframe_factor(const JointGraph<SE2>& joint, const RadioMeasurements& radio,
                                        const SequenceClosure& closure, double loss_sigmas) {
  const auto [node_i, node_j, similarity] = closure.candidate;
  const JointRobot &robot_i = robot_of_node(joint, radio, node_i),
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
  factor.information = T_l_k.covariance.inverse();
  factor.loss = {LossKind::kCauchy, loss_sigmas};
  return factor;
}

}  // namespace

std::optional<std::string> sequence_note(int dimension, const RadioMeasurements& radio,
                                         const SequenceStageParams& params) {
  if (dimension == 2 || !params.enabled || radio.nodes.empty()) return std::nullopt;
  return "stretches of way that sounded alike were not sought: sequence closures are poses in the plane, "
         "and the mission has three dimensions";
}

template <class Pose>
std::vector<SequenceTie> add_sequence_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                               const SequenceStageParams& params) {
  std::vector<SequenceTie> ties;
  if constexpr (Pose::kDim == 2) {
    if (!params.enabled) return ties;
    auto& factors = joint.team.graph.relative_poses;
    for (const SequenceClosure& closure : propose_sequence_closures(radio, params.closure)) {
      ties.push_back({closure, factors.size()});
      if (closure.fit.verdict == SequenceVerdict::kAccepted)
        factors.push_back(keyframe_factor(joint, radio, closure, params.loss_sigmas));
    }
  }
  return ties;
}

template <class Pose>
std::vector<ClosureResult> collect_sequence_closures(const JointGraph<Pose>& joint,
                                                     const RadioMeasurements& radio,
                                                     const std::vector<SequenceTie>& ties) {
  const auto keyframe_stamp = [&](std::size_t node) {
    const JointRobot& robot = robot_of_node(joint, radio, node);
    return robot.stamps[keyframe_of_node(robot, radio, node)];
  };
  std::vector<ClosureResult> results;
  for (const auto& [closure, factor] : ties) {
    const auto [i, j, similarity] = closure.candidate;
    ClosureResult result{radio.nodes[i].robot,   keyframe_stamp(i),
                         radio.nodes[j].robot,   keyframe_stamp(j),
                         ClosureKind::kSequence, ClosureStatus::kRejected,
                         closure.fit.residual_m, std::string(reason(closure.fit.verdict))};
    if (closure.fit.verdict == SequenceVerdict::kAccepted) {
      const auto& graph = joint.team.graph;
      if (squared_norm(graph, graph.relative_poses[factor]) > kPoseChiSquared99<SE2>)
        result.reason = "the estimate disagrees";
      else
        result.status = ClosureStatus::kAccepted;
    }
    results.push_back(std::move(result));
  }
  return results;
}

#define RADIOSLAM_SEQUENCE_STAGE(Pose)                                                                 \
  template std::vector<SequenceTie> add_sequence_closures(JointGraph<Pose>&, const RadioMeasurements&, \
                                                          const SequenceStageParams&);                 \
  template std::vector<ClosureResult> collect_sequence_closures(                                       \
      const JointGraph<Pose>&, const RadioMeasurements&, const std::vector<SequenceTie>&);
RADIOSLAM_SEQUENCE_STAGE(SE2)
RADIOSLAM_SEQUENCE_STAGE(SE3)
#undef RADIOSLAM_SEQUENCE_STAGE

}  // namespace radioslam
