#include "radioslam/graph/distributed/cluster.hpp"

#include <algorithm>

#include "radioslam/graph/block_structure.hpp"

namespace radioslam {
namespace {

/// Calls body(row, column) for the blocks on or below the diagonal that are not zero.
template <class Body>
void for_each_block(const Eigen::MatrixXd& matrix, Eigen::Index dof, const Body& body) {
  const Eigen::Index n = matrix.rows() / dof;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i)
      if (!matrix.block(i * dof, j * dof, dof, dof).isZero(0))
        body(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
}

}  // namespace

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

void Cluster::add_places(const std::vector<std::size_t>& variables, const Eigen::MatrixXd& information,
                         BlockPattern& pattern) const {
  for_each_block(information, dof_, [&](std::size_t i, std::size_t j) {
    const auto [low, high] = std::minmax(variables[i], variables[j]);
    if (low != high)
      pattern.lower.push_back({static_cast<std::int32_t>(high), static_cast<std::int32_t>(low)});
  });
}

void Cluster::add(const std::vector<std::size_t>& variables, const Eigen::MatrixXd& information,
                  SymmetricBlockMatrix& sum) const {
  for_each_block(information, dof_, [&](std::size_t i, std::size_t j) {
    const auto block = information.block(static_cast<Eigen::Index>(i) * dof_,
                                         static_cast<Eigen::Index>(j) * dof_, dof_, dof_);
    const std::size_t row = variables[i], column = variables[j];
    if (row == column) {
      sum.diagonal(row) += block;
      return;
    }
    const bool below = row > column;
    const auto high = static_cast<std::int32_t>(below ? row : column);
    const auto low = static_cast<std::int32_t>(below ? column : row);
    auto target = sum.lower(sum.find_lower(high, low));
    if (below)
      target += block;
    else
      target += block.transpose();
  });
}

bool Cluster::factorize(const Eigen::MatrixXd& own, const std::map<RobotNumber, Elimination>& children) {
  BlockPattern pattern;
  pattern.sizes.assign(variables_.size(), static_cast<std::int32_t>(dof_));
  add_places(own_, own, pattern);
  for (const auto& [child, up] : children) add_places(child_.at(child), *up.information, pattern);
  sort_lower(pattern);
  SymmetricBlockMatrix sum(pattern);
  sum.set_zero();
  add(own_, own, sum);
  for (const auto& [child, up] : children) add(child_.at(child), *up.information, sum);
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
