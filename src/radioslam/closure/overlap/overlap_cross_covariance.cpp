#include "radioslam/closure/overlap/overlap_cross_covariance.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "radioslam/base/check.hpp"

namespace radioslam {

template <class Pose>
std::shared_ptr<const SkeletonCovariance<Pose>> SkeletonCovariance<Pose>::compute(
    PoseGraph<Pose> reduced, const typename Pose::Point& origin,
    std::vector<std::vector<SegmentVariables>> segments) {
  std::shared_ptr<SkeletonCovariance> s(new SkeletonCovariance(std::move(reduced), origin));
  s->segments_.swap(segments);
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

/// Zero for fixed or absent variables; a segment's variables share a factor, so the selected inverse has
/// their block.
template <class Pose>
Eigen::MatrixXd SkeletonCovariance<Pose>::block(const Variable& a, const Variable& b) const {
  const auto i = equations_.blocks().of(a), j = equations_.blocks().of(b);
  if (i < 0 || j < 0) return Eigen::MatrixXd::Zero(size(a), size(b));
  const auto block = inverse_->block(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  RADIOSLAM_CHECK(block.has_value(), "a segment's variables share a factor");
  return to_left(a) * *block * to_left(b).transpose();
}

template <class Pose>
typename SkeletonCovariance<Pose>::Joint SkeletonCovariance<Pose>::within(const SegmentVariables& s) const {
  Joint joint = Joint::Zero();
  const std::array<Variable, 3> of{variable(s.first), variable(s.last), variable(s.drift)};
  const std::array<Eigen::Index, 3> at{0, kDof, Eigen::Index{2} * kDof};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (of[i].kind != VariableKind::kNone && of[j].kind != VariableKind::kNone)
        joint.block(at[i], at[j], size(of[i]), size(of[j])) = block(of[i], of[j]);
  return joint;
}

template <class Pose>
void SkeletonCovariance<Pose>::keep_columns(std::size_t robot, std::size_t scalars) const {
  if (kept_robot_ == robot) return;
  kept_robot_ = robot;
  kept_.clear();
  free_scalars_ = scalars;
}

template <class Pose>
Eigen::MatrixXd SkeletonCovariance<Pose>::inverse_columns(std::size_t block) const {
  if (const auto known = kept_.find(block); known != kept_.end()) return known->second;
  Eigen::MatrixXd columns = equations_.cholesky().inverse_columns(block);
  const auto scalars = static_cast<std::size_t>(columns.size());
  if (scalars > free_scalars_) return columns;
  free_scalars_ -= scalars;
  return kept_.emplace(block, std::move(columns)).first->second;
}

template <class Pose>
Eigen::MatrixXd SkeletonCovariance<Pose>::columns(const Variable& v,
                                                  const std::vector<Variable>& rows) const {
  Eigen::Index height = 2;
  for (const Variable& row : rows) height += size(row);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(height, size(v));
  const auto block = equations_.blocks().of(v);
  if (block < 0) return columns;
  const Eigen::MatrixXd solved = inverse_columns(static_cast<std::size_t>(block)) * to_left(v).transpose();
  Eigen::Index at = 0;
  for (const Variable& row : rows) {
    const auto other = equations_.blocks().of(row);
    if (other >= 0) {
      const auto from =
          static_cast<Eigen::Index>(equations_.matrix().offset(static_cast<std::size_t>(other)));
      columns.middleRows(at, size(row)) = to_left(row) * solved.middleRows(from, size(row));
    }
    at += size(row);
  }
  return columns;
}

template <class Pose>
typename CrossCovariance<Pose>::Listed CrossCovariance<Pose>::list_variables(
    const std::vector<SegmentVariables>& segments) {
  Listed listed;
  std::map<std::pair<int, std::int32_t>, std::size_t> places;
  const auto place = [&](const Variable& v) {
    const auto [known, is_new] =
        places.try_emplace({static_cast<int>(v.kind), v.id}, listed.variables.size());
    if (is_new) listed.variables.push_back(v);
    return known->second;
  };
  for (const SegmentVariables& s : segments) {
    const std::size_t first = place(variable(s.first)), last = place(variable(s.last));
    listed.segments.push_back(
        {first, last, s.drift.valid() ? place(variable(s.drift)) : segments.size() * 3});
  }
  for (Places& places_of : listed.segments)
    places_of.drift = std::min(places_of.drift, listed.variables.size());
  return listed;
}

template <class Pose>
CrossCovariance<Pose>::CrossCovariance(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton,
                                       std::size_t a, std::size_t b, std::size_t dense_scalars)
    : skeleton_(std::move(skeleton)),
      a_(list_variables(skeleton_->segments(a))),
      b_(list_variables(skeleton_->segments(b))) {
  Eigen::Index height = 0;
  for (const Variable& v : b_.variables) {
    rows_b_.push_back(height);
    height += SkeletonCovariance<Pose>::size(v);
  }
  rows_b_.push_back(height);  // for no drift
  skeleton_->keep_columns(a, dense_scalars);
  capacity_ = std::max<std::size_t>(2, dense_scalars / static_cast<std::size_t>((height + 2) * kDof));
  all_fit_ = a_.variables.size() <= capacity_;
  solved_ = std::vector<std::atomic<const Eigen::MatrixXd*>>(a_.variables.size() + 1);
  solved_.back() = &store_.emplace_back(Eigen::MatrixXd::Zero(height + 2, 2));
}

/// Columns that are solved for once and kept: all if they fit, else those of drifts, which every segment
/// needs.
template <class Pose>
const Eigen::MatrixXd& CrossCovariance<Pose>::kept(std::size_t v) const {
  if (const auto* known = solved_[v].load(std::memory_order_acquire)) return *known;
  const std::lock_guard lock(mutex_);
  if (const auto* known = solved_[v].load(std::memory_order_relaxed)) return *known;
  const Eigen::MatrixXd& columns = store_.emplace_back(skeleton_->columns(a_.variables[v], b_.variables));
  solved_[v].store(&columns, std::memory_order_release);
  return columns;
}

template <class Pose>
typename CrossCovariance<Pose>::Columns CrossCovariance<Pose>::latest(std::size_t v) const {
  const std::lock_guard lock(mutex_);
  if (const auto known = place_.find(v); known != place_.end()) {
    latest_.splice(latest_.begin(), latest_, known->second);
    return known->second->second;
  }
  if (latest_.size() >= capacity_) {
    place_.erase(latest_.back().first);
    latest_.pop_back();
  }
  latest_.emplace_front(v,
                        std::make_shared<Eigen::MatrixXd>(skeleton_->columns(a_.variables[v], b_.variables)));
  place_[v] = latest_.begin();
  return latest_.front().second;
}

template <class Pose>
typename CrossCovariance<Pose>::Joint CrossCovariance<Pose>::between(std::size_t s, std::size_t t) const {
  const Places &of_a = a_.segments[s], &of_b = b_.segments[t];
  const Eigen::Index first = rows_b_[of_b.first], last = rows_b_[of_b.last], drift = rows_b_[of_b.drift];
  Joint joint;
  const auto fill = [&](std::size_t variable, auto target) {
    const bool is_kept = all_fit_ || target.cols() != kDof;
    const Columns held = is_kept ? nullptr : latest(variable);
    const Eigen::MatrixXd& columns = is_kept ? kept(variable) : *held;
    target.template topRows<kDof>() = columns.middleRows<kDof>(first);
    target.template middleRows<kDof>(kDof) = columns.middleRows<kDof>(last);
    target.template bottomRows<2>() = columns.middleRows<2>(drift);
  };
  fill(of_a.first, joint.template leftCols<kDof>());
  fill(of_a.last, joint.template middleCols<kDof>(kDof));
  fill(of_a.drift, joint.template rightCols<2>());
  return joint;
}

template class SkeletonCovariance<SE2>;
template class SkeletonCovariance<SE3>;
template class CrossCovariance<SE2>;
template class CrossCovariance<SE3>;

}  // namespace radioslam
