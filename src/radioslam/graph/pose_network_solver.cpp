#include "radioslam/graph/pose_network_solver.hpp"

namespace radioslam {
namespace {

/// Only the relative poses, with blocks of a translation's size: poses are represented by points.
template <class Pose>
VariableBlocks free_blocks(const PoseGraph<Pose>& graph, const std::vector<bool>& held) {
  VariableBlocks blocks{std::vector<std::int32_t>(graph.poses.size(), -1), {}, {}, {}};
  std::int32_t next = 0;
  for (std::size_t p = 0; p < graph.poses.size(); ++p)
    if (!held[p]) blocks.poses[p] = next++;
  return blocks;
}

template <class Pose>
std::array<Variable, 2> pose_ends(const RelativePoseFactor<Pose>& f) {
  return {variable(f.i), variable(f.j)};
}

template <class Pose>
BlockPattern pose_pattern(const PoseGraph<Pose>& graph, const VariableBlocks& blocks) {
  BlockPattern pattern;
  for (const auto block : blocks.poses)
    if (block >= 0) pattern.sizes.push_back(Pose::kDim);
  for (const auto& f : graph.relative_poses) {
    const auto [a, b] = block_indices(blocks, pose_ends(f));
    if (a >= 0 && b >= 0) pattern.lower.push_back({std::max(a, b), std::min(a, b)});
  }
  sort_lower(pattern);
  return pattern;
}

}  // namespace

template <class Pose>
PoseNetworkSolver<Pose>::PoseNetworkSolver(const PoseGraph<Pose>& graph, const std::vector<bool>& held)
    : blocks_(free_blocks(graph, held)), matrix_(pose_pattern(graph, blocks_)) {
  for (const auto& f : graph.relative_poses) {
    ends_.push_back({f.i.index(), f.j.index()});
    slots_.push_back(factor_slots(matrix_, blocks_, pose_ends(f)));
  }
  if (matrix_.rows() > 0) cholesky_.emplace(matrix_.pattern());
}

template <class Pose>
void PoseNetworkSolver<Pose>::add_term(std::size_t factor, const Term& term,
                                       const std::vector<Matrix>& values) {
  const auto& [i, j] = ends_[factor];
  const auto& slots = slots_[factor];
  const Matrix wa = term.w * term.a, wb = term.w * term.b;
  const auto add_at = [&](std::int32_t block, const Matrix& diagonal, const Matrix& right_side) {
    if (block < 0) return;
    const auto b = static_cast<std::size_t>(block);
    matrix_.diagonal(b) += diagonal;
    right_side_.middleRows<Pose::kDim>(static_cast<Eigen::Index>(matrix_.offset(b))) +=
        right_side.leftCols(right_side_.cols());
  };
  const auto [block_i, block_j] = slots.blocks;
  add_at(block_j, term.w, block_i < 0 ? Matrix(wb + wa * values[i]) : wb);
  add_at(block_i, term.a.transpose() * wa,
         block_j < 0 ? Matrix(wa.transpose() * values[j] - term.a.transpose() * wb)
                     : Matrix(-term.a.transpose() * wb));
  if (slots.lower[0] < 0) return;
  auto lower = matrix_.lower(static_cast<std::size_t>(slots.lower[0]));
  if (block_j > block_i)
    lower -= wa;
  else
    lower -= wa.transpose();
}

template <class Pose>
auto PoseNetworkSolver<Pose>::solve(Eigen::Index columns, std::vector<Matrix> values,
                                    const std::vector<Term>& terms) -> std::optional<std::vector<Matrix>> {
  if (matrix_.rows() == 0) return values;
  matrix_.set_zero();
  right_side_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(matrix_.rows()), columns);
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (ends_[k][0] != ends_[k][1]) add_term(k, terms[k], values);
  if (cholesky_->factorize(matrix_) != Factorization::kDone) return std::nullopt;
  for (Eigen::Index c = 0; c < columns; ++c) {
    const Eigen::VectorXd x = cholesky_->solve(right_side_.col(c));
    if (!x.allFinite()) return std::nullopt;
    for (std::size_t p = 0; p < values.size(); ++p)
      if (blocks_.poses[p] >= 0)
        values[p].col(c) = x.segment<Pose::kDim>(
            static_cast<Eigen::Index>(matrix_.offset(static_cast<std::size_t>(blocks_.poses[p]))));
  }
  return values;
}

template class PoseNetworkSolver<SE2>;
template class PoseNetworkSolver<SE3>;

}  // namespace radioslam
