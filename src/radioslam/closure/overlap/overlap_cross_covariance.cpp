#include "radioslam/closure/overlap/overlap_cross_covariance.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {

namespace {

/// Lists the variables of a robot's segments.
template <class Pose>
class SegmentList {
 public:
  SegmentList(const PoseGraph<Pose>& reduced, const typename Pose::Point& origin,
              const VariableBlocks& blocks)
      : graph_(reduced), origin_(origin), blocks_(blocks) {}

  SkeletonSegments<Pose> list(const std::vector<SegmentVariables>& segments) {
    for (const SegmentVariables& s : segments) {
      const std::size_t first = place(variable(s.first)), last = place(variable(s.last));
      list_.places.push_back({first, last, s.drift.valid() ? place(variable(s.drift)) : kNoDrift});
    }
    return std::move(list_);
  }

 private:
  std::size_t place(const Variable& v) {
    const auto [at, is_new] = known_.try_emplace({static_cast<int>(v.kind), v.id}, list_.variables.size());
    if (!is_new) return at->second;
    SkeletonVariable<Pose>& listed = list_.variables.emplace_back();
    listed.block = blocks_.of(v);
    listed.is_pose = v.kind == VariableKind::kPose;
    if (listed.is_pose)
      listed.to_left = shifted(graph_.poses[static_cast<std::size_t>(v.id)], origin_).adjoint();
    return at->second;
  }

  const PoseGraph<Pose>& graph_;
  const typename Pose::Point& origin_;
  const VariableBlocks& blocks_;
  std::map<std::pair<int, std::int32_t>, std::size_t> known_;
  SkeletonSegments<Pose> list_;
};

}  // namespace

template <class Pose>
SkeletonInformation<Pose> information_of(const PoseGraph<Pose>& reduced, const typename Pose::Point& origin,
                                         const std::vector<std::vector<SegmentVariables>>& segments) {
  NormalEquations<Pose> equations(reduced);
  if (!equations.empty()) equations.linearise(reduced);
  SkeletonInformation<Pose> information{equations.matrix(), {}, {}};
  for (const auto* blocks : {&equations.blocks().drifts, &equations.blocks().biases})
    std::copy_if(blocks->begin(), blocks->end(), std::back_inserter(information.last),
                 [](std::int32_t block) { return block >= 0; });
  for (const auto& of_robot : segments)
    information.robots.push_back(SegmentList<Pose>(reduced, origin, equations.blocks()).list(of_robot));
  return information;
}

template <class Pose>
std::shared_ptr<SkeletonCovariance<Pose>> SkeletonCovariance<Pose>::compute(
    SkeletonInformation<Pose> information, std::size_t max_scalars) {
  std::shared_ptr<SkeletonCovariance> s(new SkeletonCovariance(std::move(information)));
  const SymmetricBlockMatrix& matrix = s->information_.matrix;
  if (matrix.rows() > 0) {
    BlockCholeskyOptions options;
    options.last = s->information_.last;
    s->cholesky_.emplace(matrix.pattern(), options);
    if (s->cholesky_->factor_scalars() > max_scalars ||
        s->cholesky_->factorize(matrix) != Factorization::kDone)
      return nullptr;
    s->parts_.emplace(s->cholesky_->partitioned_inverse());
  }
  s->list_variables();
  return s;
}

template <class Pose>
std::optional<SelectedInverse> SkeletonCovariance<Pose>::selected_inverse() const {
  if (!cholesky_) return std::nullopt;
  return cholesky_->selected_inverse();
}

/// Zero for held variables; a segment's variables share a factor, so the selected inverse has their block.
template <class Pose>
Eigen::MatrixXd SegmentCovariances<Pose>::block(const Listed& a, const Listed& b) const {
  if (!a.is_free || !b.is_free) return Eigen::MatrixXd::Zero(a.size(), b.size());
  const auto found = inverse_->block(static_cast<std::size_t>(a.block), static_cast<std::size_t>(b.block));
  RADIOSLAM_CHECK(found.has_value(), "a segment's variables share a factor");
  Eigen::MatrixXd block = *found;
  if (a.is_pose) block = a.to_left * block;
  if (b.is_pose) block = block * b.to_left.transpose();
  return block;
}

template <class Pose>
typename SkeletonCovariance<Pose>::Joint SegmentCovariances<Pose>::within(std::size_t robot,
                                                                          std::size_t segment) const {
  constexpr Eigen::Index kDof = Pose::kDof;
  Joint joint = Joint::Zero();
  const SegmentPlaces& of = skeleton_.places(robot, segment);
  const std::array<std::pair<std::size_t, Eigen::Index>, 3> at{
      {{of.first, 0}, {of.last, kDof}, {of.drift, 2 * kDof}}};
  for (const auto& [i, row] : at)
    for (const auto& [j, column] : at)
      if (i != kNoDrift && j != kNoDrift) {
        const Listed &a = skeleton_.listed(robot)[i], &b = skeleton_.listed(robot)[j];
        joint.block(row, column, a.size(), b.size()) = block(a, b);
      }
  return joint;
}

template <class Pose>
void SkeletonCovariance<Pose>::list_variables() {
  for (const auto& robot : information_.robots) {
    std::vector<Listed>& list = listed_.emplace_back();
    for (const auto& variable : robot.variables) {
      Listed& listed = list.emplace_back(Listed{variable});
      if (variable.block < 0) continue;
      const auto block = static_cast<std::size_t>(variable.block);
      listed.is_free = true;
      listed.part = parts_->part_of(block);
      listed.is_separator = parts_->is_separator(block);
      listed.by_boundary = parts_->by_boundary(block).data();
      listed.boundary = static_cast<Eigen::Index>(parts_->boundary(listed.part).size());
      listed.local_column = parts_->local_column(block);
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
  for (; end < skeleton.segments(a); ++end) {
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
    if (list[u].is_pose)
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
  for (const std::size_t k : places)
    blocks.push_back(static_cast<std::size_t>(list[batch.variables[k]].block));
  const Eigen::MatrixXd rows = skeleton_->parts()->local_rows(blocks);
  Eigen::Index row = 0;
  for (const std::size_t k : places) {
    const Listed& u = list[batch.variables[k]];
    const Eigen::Index size = size_of(batch.variables[k]);
    if (u.is_pose)
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

template SkeletonInformation<SE2> information_of(const PoseGraph<SE2>&, const SE2::Point&,
                                                 const std::vector<std::vector<SegmentVariables>>&);
template SkeletonInformation<SE3> information_of(const PoseGraph<SE3>&, const SE3::Point&,
                                                 const std::vector<std::vector<SegmentVariables>>&);
template class SkeletonCovariance<SE2>;
template class SkeletonCovariance<SE3>;
template class SegmentCovariances<SE2>;
template class SegmentCovariances<SE3>;
template class CovariancesOfRobot<SE2>;
template class CovariancesOfRobot<SE3>;
template class CrossCovariance<SE2>;
template class CrossCovariance<SE3>;

}  // namespace radioslam
