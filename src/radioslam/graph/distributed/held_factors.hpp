// The factors that one robot adds to the team's quadratic, reduced to the poses it shares with others.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/graph/distributed/message.hpp"
#include "radioslam/graph/linear/partial_elimination.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

/// A pose that stays, by its place in the robot's graph.
struct KeptPose {
  std::size_t pose = 0;
  SharedPose shared;
};

template <class Pose>
class HeldFactors {
 public:
  /// `factors`: places in robot.graph.relative_poses of those that are held, within the robot and between;
  /// `kept`: poses whose steps are not solved for inside. `anchored`: the robot's first pose stays at rest,
  /// which chooses the frame of the whole team; where others hold all of its factors, the first that is kept.
  HeldFactors(const RobotGraph<Pose>& robot, const std::vector<std::size_t>& factors,
              std::vector<KeptPose> kept, bool anchored);

  std::vector<SharedPose> kept() const;
  /// Linearises at the robot's poses, with a weight per factor of `factors` besides its own; the cost there.
  double linearise(const std::vector<Pose>& poses, const std::vector<double>& weights);
  /// The information on the kept steps; false where the rest is not positive definite.
  bool eliminate(double damping);
  const Eigen::MatrixXd& information() const { return information_; }
  /// With the gradients of the last linearisation and the information of the last elimination.
  Eigen::VectorXd gradient() const;
  double predicted_decrease() const;
  /// Moves own poses and copies by the kept steps and those that follow from them.
  void apply(const Eigen::VectorXd& kept_steps, std::vector<Pose>& poses) const;

 private:
  PoseGraph<Pose> graph_;
  std::vector<double> weights_;  ///< the factors' own
  std::vector<KeptPose> kept_;
  std::vector<Eigen::Index> kept_with_block_;  ///< scalars of kept steps that some factor is about
  NormalEquations<Pose> equations_;
  std::optional<PartialElimination> inner_;
  Eigen::MatrixXd information_;
  std::optional<typename Pose::Jacobian> kept_anchor_;  ///< on the first kept pose, where no factor is held
};

}  // namespace radioslam
