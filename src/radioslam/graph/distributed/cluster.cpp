#include "radioslam/graph/distributed/cluster.hpp"

#include <algorithm>

#include "radioslam/graph/block_structure.hpp"

namespace radioslam {
Cluster::Cluster(RobotNumber self, const std::vector<SharedPose>& own,
                 const std::map<RobotNumber, Elimination>& children, Eigen::Index dof)
    : dof_(dof) {
  for (const SharedPose& pose : own) own_.push_back(place_of(pose));
  for (const auto& [child, up] : children) {
    auto& places = child_[child];
    for (const SharedPose& pose : up.shared) places.push_back(place_of(pose));
  }
  for (std::size_t v = 0; v < variables_.size(); ++v)
    if (variables_[v].solved_by != self) passed_.push_back(v);
  // Along trajectories, so that the factor of what they leave has few blocks.
  std::sort(passed_.begin(), passed_.end(),
            [&](std::size_t a, std::size_t b) { return variables_[a].key < variables_[b].key; });
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

void Cluster::add_places(const std::vector<std::size_t>& variables, const BlockInformation& information,
                         BlockPattern& pattern) const {
  for (const auto& place : information.places()) {
    const auto [low, high] = std::minmax(variables[place.row], variables[place.column]);
    if (low != high)
      pattern.lower.push_back({static_cast<std::int32_t>(high), static_cast<std::int32_t>(low)});
  }
}

void Cluster::add(const std::vector<std::size_t>& variables, const BlockInformation& information,
                  SymmetricBlockMatrix& sum) const {
  for (std::size_t k = 0; k < information.places().size(); ++k) {
    const auto block = information.block(k);
    const std::size_t row = variables[information.places()[k].row];
    const std::size_t column = variables[information.places()[k].column];
    if (row == column) {
      sum.diagonal(row) += block;
      continue;
    }
    const bool below = row > column;
    const auto high = static_cast<std::int32_t>(below ? row : column);
    const auto low = static_cast<std::int32_t>(below ? column : row);
    auto target = sum.lower(sum.find_lower(high, low));
    if (below)
      target += block;
    else
      target += block.transpose();
  }
}

bool Cluster::factorize(const Eigen::MatrixXd& own, const std::map<RobotNumber, Elimination>& children) {
  std::vector<std::pair<const std::vector<std::size_t>*, BlockInformation>> terms;
  terms.emplace_back(&own_, BlockInformation(own, dof_));
  for (const auto& [child, up] : children) terms.emplace_back(&child_.at(child), up.information->matrix());
  BlockPattern pattern;
  pattern.sizes.assign(variables_.size(), static_cast<std::int32_t>(dof_));
  for (const auto& [places, information] : terms) add_places(*places, information, pattern);
  sort_lower(pattern);
  SymmetricBlockMatrix sum(pattern);
  sum.set_zero();
  for (const auto& [places, information] : terms) add(*places, information, sum);
  elimination_.emplace(sum.pattern(), passed_);
  return elimination_->factorize(sum) == Factorization::kDone;
}

void Cluster::set_gradient(const Eigen::VectorXd& own, const std::map<RobotNumber, Elimination>& children) {
  gradient_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(variables_.size()) * dof_);
  gradient_(scalars(own_)) += own;
  for (const auto& [child, up] : children) gradient_(scalars(child_.at(child))) += up.gradient;
}

std::vector<SharedPose> Cluster::passed_poses() const {
  std::vector<SharedPose> poses;
  for (const std::size_t v : passed_) poses.push_back(variables_[v]);
  return poses;
}

Eigen::VectorXd Cluster::passed_gradient() const { return elimination_->reduce(gradient_); }
double Cluster::predicted_decrease() const { return elimination_->eliminated_norm(gradient_); }
Eigen::VectorXd Cluster::steps(const Eigen::VectorXd& passed) const {
  return elimination_->expand(-gradient_, passed);
}

Eigen::VectorXd Cluster::own_steps(const Eigen::VectorXd& steps) const { return steps(scalars(own_)); }
Eigen::VectorXd Cluster::child_steps(RobotNumber child, const Eigen::VectorXd& steps) const {
  return steps(scalars(child_.at(child)));
}

}  // namespace radioslam
