#include "radioslam/graph/distributed/cluster.hpp"

#include <algorithm>

namespace radioslam {

Cluster::Cluster(RobotNumber self, const std::vector<SharedPose>& own,
                 const std::map<RobotNumber, Elimination>& children, Eigen::Index dof)
    : dof_(dof) {
  for (const SharedPose& pose : own) own_.push_back(place_of(pose));
  for (const auto& [child, up] : children) {
    auto& places = child_[child];
    for (const SharedPose& pose : up.shared) places.push_back(place_of(pose));
  }
  std::vector<std::size_t> solved;
  for (std::size_t v = 0; v < variables_.size(); ++v)
    (variables_[v].solved_by == self ? solved : passed_variables_).push_back(v);
  // Along trajectories, so that the factor of what they leave has few blocks.
  std::sort(passed_variables_.begin(), passed_variables_.end(),
            [&](std::size_t a, std::size_t b) { return variables_[a].key < variables_[b].key; });
  solved_ = scalars(solved);
  passed_ = scalars(passed_variables_);
}

std::size_t Cluster::place_of(const SharedPose& pose) {
  const auto known = std::find_if(variables_.begin(), variables_.end(),
                                  [&](const SharedPose& v) { return v.key == pose.key; });
  if (known == variables_.end()) {
    variables_.push_back(pose);
    return variables_.size() - 1;
  }
  if (pose.solved_by != kUnknownRobot) known->solved_by = pose.solved_by;
  return static_cast<std::size_t>(known - variables_.begin());
}

std::vector<Eigen::Index> Cluster::scalars(const std::vector<std::size_t>& variables) const {
  std::vector<Eigen::Index> scalars;
  for (const std::size_t v : variables)
    for (Eigen::Index k = 0; k < dof_; ++k) scalars.push_back(static_cast<Eigen::Index>(v) * dof_ + k);
  return scalars;
}

bool Cluster::factorize(const Eigen::MatrixXd& own, const std::map<RobotNumber, Elimination>& children) {
  const auto size = static_cast<Eigen::Index>(variables_.size()) * dof_;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  const auto own_scalars = scalars(own_);
  sum(own_scalars, own_scalars) += own;
  for (const auto& [child, up] : children) {
    const auto its = scalars(child_.at(child));
    sum(its, its) += *up.information;
  }
  factor_.compute(sum(solved_, solved_));
  if (factor_.info() != Eigen::Success) return false;
  solved_passed_ = sum(solved_, passed_);
  passed_information_ = sum(passed_, passed_);
  passed_information_.noalias() -= solved_passed_.transpose() * factor_.solve(solved_passed_);
  return true;
}

void Cluster::set_gradient(const Eigen::VectorXd& own, const std::map<RobotNumber, Elimination>& children) {
  gradient_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(variables_.size()) * dof_);
  gradient_(scalars(own_)) += own;
  for (const auto& [child, up] : children) gradient_(scalars(child_.at(child))) += up.gradient;
}

std::vector<SharedPose> Cluster::passed_poses() const {
  std::vector<SharedPose> poses;
  for (const std::size_t v : passed_variables_) poses.push_back(variables_[v]);
  return poses;
}

Eigen::VectorXd Cluster::passed_gradient() const {
  return gradient_(passed_) - solved_passed_.transpose() * factor_.solve(Eigen::VectorXd(gradient_(solved_)));
}

double Cluster::predicted_decrease() const {
  const Eigen::VectorXd g = gradient_(solved_);
  return g.dot(factor_.solve(g));
}

Eigen::VectorXd Cluster::steps(const Eigen::VectorXd& passed) const {
  Eigen::VectorXd steps(gradient_.size());
  steps(passed_) = passed;
  steps(solved_) = -factor_.solve(Eigen::VectorXd(gradient_(solved_) + solved_passed_ * passed));
  return steps;
}

Eigen::VectorXd Cluster::own_steps(const Eigen::VectorXd& steps) const { return steps(scalars(own_)); }
Eigen::VectorXd Cluster::child_steps(RobotNumber child, const Eigen::VectorXd& steps) const {
  return steps(scalars(child_.at(child)));
}

}  // namespace radioslam
