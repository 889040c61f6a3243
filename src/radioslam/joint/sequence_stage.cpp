#include "radioslam/joint/sequence_stage.hpp"

#include <string>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"

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

/// The closure moved to keyframes, T_k_l = T_k_i T_i_j T_j_l, over the odometry to either fingerprint.
VerifiedClosure at_keyframes(const JointGraph<SE2>& joint, const RadioMeasurements& radio,
                             const SequenceClosure& sequence) {
  const auto [node_i, node_j, similarity] = sequence.candidate;
  const RobotVariables &robot_i = robot_of_node(joint, radio, node_i),
                       &robot_j = robot_of_node(joint, radio, node_j);
  const std::size_t k = keyframe_of_node(robot_i, radio, node_i);
  const std::size_t l = keyframe_of_node(robot_j, radio, node_j);
  VerifiedClosure verified;
  auto& [closure, judgement] = verified;
  closure.kind = ClosureKind::kSequence;
  closure.robot_i = radio.nodes[node_i].robot;
  closure.robot_j = radio.nodes[node_j].robot;
  closure.stamp_i = robot_i.stamps[k];
  closure.stamp_j = robot_j.stamps[l];
  judgement.statistic = sequence.fit.residual_m;
  if (sequence.fit.status != SequenceStatus::kAccepted) {
    reject(judgement, std::string(reason(sequence.fit.status)));
    return verified;
  }
  const UncertainPose<SE2> T_k_i{flatten(robot_i.odometry[k].inverse() * radio.at(node_i).T_start_body)};
  const UncertainPose<SE2> T_j_l{flatten(radio.at(node_j).T_start_body.inverse() * robot_j.odometry[l])};
  const UncertainPose<SE2> T_j_i{sequence.fit.T_j_i, sequence.fit.covariance};
  const auto T_k_l = T_k_i * T_j_i.inverse() * T_j_l;
  closure.T_i_j = lift(T_k_l.pose);
  closure.information = information_in_space<SE2>(inverse(T_k_l.covariance));
  return verified;
}

}  // namespace

std::optional<std::string> sequence_note(int dimension, const RadioMeasurements& radio,
                                         const SequenceStageParams& params) {
  if (dimension == 2 || !params.enabled || radio.nodes.empty()) return std::nullopt;
  return "sequence closures were skipped: they are poses in the plane, and the mission has three dimensions";
}

std::vector<SequenceClosure> match_sequences(int dimension, const RadioMeasurements& radio,
                                             const SequenceStageParams& params,
                                             const EarlierSequences* earlier) {
  if (dimension != 2 || !params.enabled) return {};
  return match_sequences(radio, params.closure, earlier);
}

template <class Pose>
std::vector<VerifiedClosure> add_sequence_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                                   const std::vector<SequenceClosure>& matched,
                                                   const SequenceStageParams& params) {
  std::vector<VerifiedClosure> closures;
  if constexpr (Pose::kDim == 2) {
    for (const SequenceClosure& sequence : choose_sequences(radio, matched, params.closure)) {
      closures.push_back(at_keyframes(joint, radio, sequence));
      const auto& [closure, judgement] = closures.back();
      if (judgement.status != ClosureStatus::kAccepted) continue;
      RelativePoseFactor<Pose> factor = closure_factor(joint, closure);
      factor.loss = {LossKind::kCauchy, params.loss_sigmas};
      add_closure(joint, closure, std::move(factor), FactorSource::kSequence, closures.size() - 1);
    }
  }
  return closures;
}

#define RADIOSLAM_SEQUENCES(Pose)                                                                          \
  template std::vector<VerifiedClosure> add_sequence_closures(JointGraph<Pose>&, const RadioMeasurements&, \
                                                              const std::vector<SequenceClosure>&,         \
                                                              const SequenceStageParams&);
RADIOSLAM_SEQUENCES(SE2)
RADIOSLAM_SEQUENCES(SE3)
#undef RADIOSLAM_SEQUENCES

}  // namespace radioslam
