// A robot's cluster of the junction tree over a team: the quadratic in the steps of the poses it shares with
// others, its own and its children's, of which it eliminates those that nobody above needs.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "radioslam/graph/distributed/message.hpp"
#include "radioslam/graph/linear/partial_elimination.hpp"

namespace radioslam {

class Cluster {
 public:
  /// `own`: what the robot's own factors are about; `children`: eliminations with information. A pose is
  /// solved for by the robot that its own robot names. `dof`: scalars of a step.
  Cluster(RobotNumber self, const std::vector<SharedPose>& own,
          const std::map<RobotNumber, Elimination>& children, Eigen::Index dof);

  /// Whether every pose is solved for somewhere above or here; always so unless a message lied.
  bool closed_at_root() const { return passed_.empty(); }

  /// Adds up the information and eliminates; false where it is not positive definite.
  bool factorize(const Eigen::MatrixXd& own, const std::map<RobotNumber, Elimination>& children);
  void set_gradient(const Eigen::VectorXd& own, const std::map<RobotNumber, Elimination>& children);

  /// The poses passed on.
  std::vector<SharedPose> passed_poses() const;
  /// What elimination leaves on their steps.
  const Eigen::MatrixXd& passed_information() const { return elimination_->reduced(); }
  Eigen::VectorXd passed_gradient() const;
  /// Decrease of the quadratic by the poses solved here, those passed at rest.
  double predicted_decrease() const;

  /// Steps of all poses of the cluster, given those of the passed ones.
  Eigen::VectorXd steps(const Eigen::VectorXd& passed) const;
  Eigen::VectorXd own_steps(const Eigen::VectorXd& steps) const;
  Eigen::VectorXd child_steps(RobotNumber child, const Eigen::VectorXd& steps) const;

 private:
  std::size_t place_of(const SharedPose& pose);
  void add_places(const std::vector<std::size_t>& variables, const BlockInformation& information,
                  BlockPattern& pattern) const;
  void add(const std::vector<std::size_t>& variables, const BlockInformation& information,
           SymmetricBlockMatrix& sum) const;
  std::vector<Eigen::Index> scalars(const std::vector<std::size_t>& variables) const;

  Eigen::Index dof_;
  std::vector<SharedPose> variables_;
  std::vector<std::size_t> own_;
  std::map<RobotNumber, std::vector<std::size_t>> child_;
  std::vector<std::size_t> passed_;  ///< variables
  std::optional<PartialElimination> elimination_;
  Eigen::VectorXd gradient_;
};

}  // namespace radioslam
