#include "radioslam/closure/overlap_cross_covariance.hpp"

#include <array>
#include <map>

#include "radioslam/base/check.hpp"

namespace radioslam {

template <class Pose>
std::shared_ptr<const SkeletonCovariance<Pose>> SkeletonCovariance<Pose>::compute(
    PoseGraph<Pose> reduced, const typename Pose::Point& origin,
    std::vector<std::vector<StretchVariables>> stretches) {
  std::shared_ptr<SkeletonCovariance> s(new SkeletonCovariance(std::move(reduced), origin));
  s->stretches_ = std::move(stretches);
  if (s->equations_.empty()) return s;
  s->equations_.linearise(s->graph_);
  if (s->equations_.factorize(0) != Factorization::kDone) return nullptr;
  s->inverse_ = s->equations_.cholesky().selected_inverse();
  return s;
}

template <class Pose>
Eigen::MatrixXd SkeletonCovariance<Pose>::to_left(const Variable& v) const {
  if (v.kind != VariableKind::kPose) return Eigen::MatrixXd::Identity(size(v), size(v));
  return shifted(graph_.poses[static_cast<std::size_t>(v.id)], origin_).adjoint();
}

/// Zero for what is held or not there; a stretch's variables are all in one factor, so the inverse has them.
template <class Pose>
Eigen::MatrixXd SkeletonCovariance<Pose>::block(const Variable& a, const Variable& b) const {
  const auto i = equations_.blocks().of(a), j = equations_.blocks().of(b);
  if (i < 0 || j < 0) return Eigen::MatrixXd::Zero(size(a), size(b));
  const auto block = inverse_->block(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  RADIOSLAM_CHECK(block.has_value(), "a stretch's variables share a factor");
  return to_left(a) * *block * to_left(b).transpose();
}

template <class Pose>
typename SkeletonCovariance<Pose>::Joint SkeletonCovariance<Pose>::within(const StretchVariables& s) const {
  Joint joint = Joint::Zero();
  const std::array<Variable, 3> of{variable(s.first), variable(s.last), variable(s.drift)};
  const std::array<Eigen::Index, 3> at{0, kDof, 2 * kDof};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (of[i].kind != VariableKind::kNone && of[j].kind != VariableKind::kNone)
        joint.block(at[i], at[j], size(of[i]), size(of[j])) = block(of[i], of[j]);
  return joint;
}

template <class Pose>
Eigen::MatrixXd SkeletonCovariance<Pose>::columns(const StretchVariables& s,
                                                  const std::vector<Variable>& rows) const {
  const std::array<Variable, 3> of{variable(s.first), variable(s.last), variable(s.drift)};
  const std::array<Eigen::Index, 3> at{0, kDof, 2 * kDof};
  Eigen::Index height = 2;  // two rows of zeros for stretches without a drift
  for (const Variable& v : rows) height += size(v);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(height, kSize);
  for (std::size_t j = 0; j < 3; ++j) {
    const auto block = equations_.blocks().of(of[j]);
    if (of[j].kind == VariableKind::kNone || block < 0) continue;
    const Eigen::MatrixXd solved =
        equations_.cholesky().inverse_columns(static_cast<std::size_t>(block)) * to_left(of[j]).transpose();
    Eigen::Index row = 0;
    for (const Variable& v : rows) {
      const auto other = equations_.blocks().of(v);
      if (other >= 0) {
        const auto from =
            static_cast<Eigen::Index>(equations_.matrix().offset(static_cast<std::size_t>(other)));
        columns.block(row, at[j], size(v), size(of[j])) = to_left(v) * solved.middleRows(from, size(v));
      }
      row += size(v);
    }
  }
  return columns;
}

template <class Pose>
CrossCovariance<Pose>::CrossCovariance(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton,
                                       std::size_t a, std::size_t b, std::size_t dense_scalars)
    : skeleton_(std::move(skeleton)), a_(a) {
  std::map<std::pair<int, std::int32_t>, Eigen::Index> row_of;
  Eigen::Index height = 0;
  const auto row = [&](const Variable& v) {
    const auto [place, is_new] = row_of.try_emplace({static_cast<int>(v.kind), v.id}, height);
    if (is_new) {
      variables_b_.push_back(v);
      height += v.kind == VariableKind::kPose ? kDof : 2;
    }
    return place->second;
  };
  for (const StretchVariables& t : skeleton_->stretches(b))
    rows_b_.push_back(
        {row(variable(t.first)), row(variable(t.last)), t.drift.valid() ? row(variable(t.drift)) : -1});
  for (Rows& rows : rows_b_)
    if (rows.drift < 0) rows.drift = height;
  const std::size_t stretches = skeleton_->stretches(a).size();
  const auto per_stretch = static_cast<std::size_t>((height + 2) * kSize);
  capacity_ = std::max<std::size_t>(1, dense_scalars / per_stretch);
  if (stretches > capacity_) return;
  for (std::size_t s = 0; s < stretches; ++s)
    all_.push_back(
        std::make_shared<Eigen::MatrixXd>(skeleton_->columns(skeleton_->stretches(a)[s], variables_b_)));
}

template <class Pose>
typename CrossCovariance<Pose>::Columns CrossCovariance<Pose>::latest(std::size_t s) const {
  const std::lock_guard lock(mutex_);
  if (const auto known = place_.find(s); known != place_.end()) {
    latest_.splice(latest_.begin(), latest_, known->second);
    return known->second->second;
  }
  if (latest_.size() >= capacity_) {
    place_.erase(latest_.back().first);
    latest_.pop_back();
  }
  const auto& stretch = skeleton_->stretches(a_)[s];
  latest_.emplace_front(s, std::make_shared<Eigen::MatrixXd>(skeleton_->columns(stretch, variables_b_)));
  place_[s] = latest_.begin();
  return latest_.front().second;
}

template <class Pose>
typename CrossCovariance<Pose>::Joint CrossCovariance<Pose>::between(std::size_t s, std::size_t t) const {
  const Columns held = all_.empty() ? latest(s) : nullptr;
  const Eigen::MatrixXd& columns = held ? *held : *all_[s];
  const Rows& rows = rows_b_[t];
  Joint joint;
  joint.template topRows<kDof>() = columns.middleRows<kDof>(rows.first);
  joint.template middleRows<kDof>(kDof) = columns.middleRows<kDof>(rows.last);
  joint.template bottomRows<2>() = columns.middleRows<2>(rows.drift);
  return joint;
}

template class SkeletonCovariance<SE2>;
template class SkeletonCovariance<SE3>;
template class CrossCovariance<SE2>;
template class CrossCovariance<SE3>;

}  // namespace radioslam
