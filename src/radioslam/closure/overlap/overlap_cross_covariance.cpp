#include "radioslam/closure/overlap/overlap_cross_covariance.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {

template <class Pose>
std::shared_ptr<SkeletonCovariance<Pose>> SkeletonCovariance<Pose>::compute(
    PoseGraph<Pose> reduced, const typename Pose::Point& origin,
    std::vector<std::vector<SegmentVariables>> segments) {
  std::shared_ptr<SkeletonCovariance> s(new SkeletonCovariance(std::move(reduced), origin));
  s->segments_.swap(segments);
  if (s->equations_.empty()) {
    s->list_variables();
    return s;
  }
  s->equations_.linearise(s->graph_);
  if (s->equations_.factorize(0) != Factorization::kDone) return nullptr;
  s->inverse_ = s->equations_.cholesky().selected_inverse();
  s->parts_.emplace(s->equations_.cholesky().partitioned_inverse());
  s->list_variables();
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
void SkeletonCovariance<Pose>::list_variables() {
  for (const auto& segments : segments_) {
    std::vector<Listed>& list = listed_.emplace_back();
    std::vector<SegmentPlaces>& places = places_.emplace_back();
    std::map<std::pair<int, std::int32_t>, std::size_t> known;
    const auto place = [&](const Variable& v) {
      const auto [at, is_new] = known.try_emplace({static_cast<int>(v.kind), v.id}, list.size());
      if (!is_new) return at->second;
      Listed& listed = list.emplace_back();
      listed.variable = v;
      if (v.kind == VariableKind::kPose) listed.to_left = to_left(v);
      if (const auto block = equations_.blocks().of(v); block >= 0) {
        listed.is_free = true;
        listed.block = static_cast<std::size_t>(block);
        listed.part = parts_->part_of(listed.block);
        listed.is_separator = parts_->is_separator(listed.block);
        listed.by_boundary = parts_->by_boundary(listed.block).data();
        listed.boundary = static_cast<Eigen::Index>(parts_->boundary(listed.part).size());
        listed.local_column = parts_->local_column(listed.block);
      }
      return at->second;
    };
    for (const SegmentVariables& s : segments) {
      const std::size_t first = place(variable(s.first)), last = place(variable(s.last));
      places.push_back({first, last, s.drift.valid() ? place(variable(s.drift)) : kNoDrift});
    }
  }
}

template <class Pose>
CovariancesOfRobot<Pose>::CovariancesOfRobot(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton,
                                             std::size_t a, std::size_t first_segment,
                                             std::size_t last_segment)
    : skeleton_(std::move(skeleton)),
      a_(a),
      places_(skeleton_->listed(a).size()),
      parts_of_later_(parts_of_later(*skeleton_, a)) {
  list_batches(first_segment, last_segment);
  parallel_for(batches_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) compute(batches_[k]);
  });
}

template <class Pose>
Eigen::Index CovariancesOfRobot<Pose>::size_of(std::size_t u) const {
  return SkeletonCovariance<Pose>::size(skeleton_->listed(a_)[u].variable);
}

/// Variables of one part are together.
template <class Pose>
void CovariancesOfRobot<Pose>::list_batches(std::size_t first_segment, std::size_t last_segment) {
  const auto& list = skeleton_->listed(a_);
  std::vector<bool> known(list.size(), false);
  std::vector<std::size_t> variables;
  for (std::size_t s = first_segment; s < last_segment; ++s) {
    const SegmentPlaces& segment = skeleton_->places(a_, s);
    for (const std::size_t u : {segment.first, segment.last, segment.drift}) {
      if (u == kNoDrift || known[u] || !list[u].is_free) continue;
      known[u] = true;
      variables.push_back(u);
    }
  }
  std::stable_sort(variables.begin(), variables.end(),
                   [&](std::size_t u, std::size_t v) { return list[u].part < list[v].part; });
  for (std::size_t begin = 0; begin < variables.size(); begin += kBatch) {
    Batch& batch = batches_.emplace_back();
    Eigen::Index column = 0;
    for (std::size_t k = begin; k < std::min(variables.size(), begin + kBatch); ++k) {
      places_[variables[k]] = {batches_.size() - 1, batch.variables.size(), column};
      batch.variables.push_back(variables[k]);
      column += size_of(variables[k]);
    }
  }
}

template <class Pose>
std::vector<std::size_t> CovariancesOfRobot<Pose>::parts_of_later(const SkeletonCovariance<Pose>& skeleton,
                                                                  std::size_t a) {
  std::vector<std::size_t> parts;
  if (!skeleton.parts()) return parts;
  std::vector<bool> found(skeleton.parts()->parts(), false);
  for (std::size_t b = a + 1; b < skeleton.robots(); ++b)
    for (const Listed& v : skeleton.listed(b))
      if (v.is_free) found[v.part] = true;
  for (std::size_t p = 0; p < found.size(); ++p)
    if (found[p]) parts.push_back(p);
  return parts;
}

template <class Pose>
std::size_t CovariancesOfRobot<Pose>::segments_within(const SkeletonCovariance<Pose>& skeleton, std::size_t a,
                                                      std::size_t first_segment, std::size_t scalars) {
  std::size_t of_boundaries = 0;
  for (const std::size_t p : parts_of_later(skeleton, a))
    of_boundaries += skeleton.parts()->boundary(p).size();
  const auto& list = skeleton.listed(a);
  std::vector<bool> known(list.size(), false);
  std::size_t taken = 0, end = first_segment;
  for (; end < skeleton.segments(a).size(); ++end) {
    const SegmentPlaces& segment = skeleton.places(a, end);
    for (const std::size_t u : {segment.first, segment.last, segment.drift}) {
      if (u == kNoDrift || known[u] || !list[u].is_free) continue;
      known[u] = true;
      const std::size_t local = list[u].is_separator ? 0 : skeleton.parts()->part_scalars(list[u].part);
      taken += kDof * (of_boundaries + local);
    }
    if (taken > scalars && end > first_segment) break;
  }
  return end;
}

/// A^T of variables of one part, in left perturbations, side by side.
template <class Pose>
Eigen::MatrixXd CovariancesOfRobot<Pose>::maps_of(const std::vector<std::size_t>& variables) const {
  const auto& list = skeleton_->listed(a_);
  Eigen::Index columns = 0;
  for (const std::size_t u : variables) columns += size_of(u);
  Eigen::MatrixXd maps(list[variables.front()].boundary, columns);
  Eigen::Index column = 0;
  for (const std::size_t u : variables) {
    const Eigen::Map<const Eigen::MatrixXd> map(list[u].by_boundary, list[u].boundary, size_of(u));
    if (list[u].variable.kind == VariableKind::kPose)
      maps.middleCols(column, size_of(u)) = map.lazyProduct(list[u].to_left.transpose());
    else
      maps.middleCols(column, size_of(u)) = map;
    column += size_of(u);
  }
  return maps;
}

/// Of the batch's variables at these places, which are of one part.
template <class Pose>
void CovariancesOfRobot<Pose>::add_local(Batch& batch, const std::vector<std::size_t>& places) const {
  const auto& list = skeleton_->listed(a_);
  std::vector<std::size_t> blocks;
  for (const std::size_t k : places) blocks.push_back(list[batch.variables[k]].block);
  const Eigen::MatrixXd rows = skeleton_->parts()->local_rows(blocks);
  Eigen::Index row = 0;
  for (const std::size_t k : places) {
    const Listed& u = list[batch.variables[k]];
    const Eigen::Index size = size_of(batch.variables[k]);
    if (u.variable.kind == VariableKind::kPose)
      batch.local[k] = rows.middleRows(row, size).transpose().lazyProduct(u.to_left.transpose());
    else
      batch.local[k] = rows.middleRows(row, size).transpose();
    row += size;
  }
}

/// With the separators: Cov(S, u) = Cov(S, boundary) A_u^T. Within the parts: a part's variables at once.
template <class Pose>
void CovariancesOfRobot<Pose>::compute(Batch& batch) const {
  const auto& list = skeleton_->listed(a_);
  const PartitionedInverse& parts = *skeleton_->parts();
  const Eigen::MatrixXd& separators = parts.separators();
  const std::size_t count = batch.variables.size(), last = batch.variables.back();
  Eigen::MatrixXd with_separators(separators.rows(), places_[last].column + size_of(last));
  batch.local.resize(count);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const std::size_t part = list[batch.variables[begin]].part;
    std::vector<std::size_t> variables, inner;
    for (; end < count && list[batch.variables[end]].part == part; ++end) {
      variables.push_back(batch.variables[end]);
      if (!list[batch.variables[end]].is_separator) inner.push_back(end);
    }
    const auto& boundary = parts.boundary(part);
    const Eigen::MatrixXd maps = maps_of(variables);
    front_kernels().multiply(
        {separators.data(), static_cast<std::size_t>(separators.rows()), boundary.data(), boundary.size()},
        static_cast<std::size_t>(maps.cols()), maps.data(),
        with_separators.col(places_[variables.front()].column).data());
    if (!inner.empty()) add_local(batch, inner);
  }
  batch.with_boundary.resize(parts.parts());
  for (const std::size_t p : parts_of_later_) {
    const auto& boundary = parts.boundary(p);
    Eigen::MatrixXd& with = batch.with_boundary[p];
    with.resize(static_cast<Eigen::Index>(boundary.size()), with_separators.cols());
    for (Eigen::Index column = 0; column < with.cols(); ++column)
      for (std::size_t k = 0; k < boundary.size(); ++k)
        with(static_cast<Eigen::Index>(k), column) = with_separators(boundary[k], column);
  }
}

template <class Pose>
template <int kRows, int kColumns>
Eigen::Matrix<double, kRows, kColumns> CovariancesOfRobot<Pose>::with(const Listed& v, std::size_t u) const {
  using Block = Eigen::Matrix<double, kRows, kColumns>;
  const Listed& of_a = skeleton_->listed(a_)[u];
  if (!v.is_free || !of_a.is_free) return Block::Zero();
  const Place& at = places_[u];
  RADIOSLAM_CHECK(at.batch != kNone, "the variable belongs to the segments asked for");
  const Batch& batch = batches_[at.batch];
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, kRows>> map(v.by_boundary, v.boundary, kRows);
  Block block =
      map.transpose().lazyProduct(batch.with_boundary[v.part].template middleCols<kColumns>(at.column));
  if (v.part == of_a.part && !v.is_separator && !of_a.is_separator)
    block += batch.local[at.variable].template middleRows<kRows>(v.local_column);
  if constexpr (kRows == kDof) return v.to_left.lazyProduct(block);
  return block;
}

template <class Pose>
typename CrossCovariance<Pose>::Joint CrossCovariance<Pose>::between(std::size_t s, Ends of_s, std::size_t t,
                                                                     Ends of_t) const {
  const SkeletonCovariance<Pose>& skeleton = of_a_->skeleton();
  const SegmentPlaces &a = skeleton.places(of_a_->robot(), s), &b = skeleton.places(b_, t);
  const auto& list = skeleton.listed(b_);
  Joint joint = Joint::Zero();
  const auto fill = [&](std::size_t u, auto target) {
    constexpr int kColumns = decltype(target)::ColsAtCompileTime;
    if (of_t.first) target.template topRows<kDof>() = of_a_->template with<kDof, kColumns>(list[b.first], u);
    if (of_t.last)
      target.template middleRows<kDof>(kDof) = of_a_->template with<kDof, kColumns>(list[b.last], u);
    if (b.drift != kNoDrift)
      target.template bottomRows<2>() = of_a_->template with<2, kColumns>(list[b.drift], u);
  };
  if (of_s.first) fill(a.first, joint.template leftCols<kDof>());
  if (of_s.last) fill(a.last, joint.template middleCols<kDof>(kDof));
  if (a.drift != kNoDrift) fill(a.drift, joint.template rightCols<2>());
  return joint;
}

template class SkeletonCovariance<SE2>;
template class SkeletonCovariance<SE3>;
template class CovariancesOfRobot<SE2>;
template class CovariancesOfRobot<SE3>;
template class CrossCovariance<SE2>;
template class CrossCovariance<SE3>;

}  // namespace radioslam
