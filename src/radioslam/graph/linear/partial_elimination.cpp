#include "radioslam/graph/linear/partial_elimination.hpp"

#include <Eigen/SparseCore>
#include <algorithm>

namespace radioslam {
namespace {

BlockPattern inner_pattern(const BlockPattern& pattern, const std::vector<std::int32_t>& place) {
  BlockPattern inner;
  for (std::size_t b = 0; b < pattern.blocks(); ++b)
    if (place[b] >= 0) inner.sizes.push_back(pattern.sizes[b]);
  for (const auto& [row, column] : pattern.lower) {
    const auto r = place[static_cast<std::size_t>(row)], c = place[static_cast<std::size_t>(column)];
    if (r >= 0 && c >= 0) inner.lower.push_back({r, c});
  }
  return inner;  // eliminated blocks keep their order, so that this stays sorted
}

/// Replaces both halves by their mean, tile by tile.
void make_symmetric(Eigen::MatrixXd& matrix) {
  constexpr Eigen::Index kTile = 32;
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index column = 0; column < n; column += kTile)
    for (Eigen::Index row = column; row < n; row += kTile)
      for (Eigen::Index c = column; c < std::min(column + kTile, n); ++c)
        for (Eigen::Index r = std::max(row, c + 1); r < std::min(row + kTile, n); ++r)
          matrix(r, c) = matrix(c, r) = (matrix(r, c) + matrix(c, r)) / 2;
}

}  // namespace

PartialElimination::PartialElimination(const BlockPattern& pattern, const std::vector<std::size_t>& kept)
    : place_(pattern.blocks(), 0) {
  Eigen::Index offset = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    place_[kept[k]] = -1 - static_cast<std::int32_t>(k);
    kept_offsets_.push_back(offset);
    offset += pattern.sizes[kept[k]];
  }
  std::int32_t next = 0;
  for (auto& place : place_)
    if (place >= 0) place = next++;
  std::vector<std::size_t> begins{0};
  for (const auto size : pattern.sizes) begins.push_back(begins.back() + static_cast<std::size_t>(size));
  const auto list = [&](std::size_t block, std::vector<std::size_t>& scalars) {
    for (std::size_t s = begins[block]; s < begins[block + 1]; ++s) scalars.push_back(s);
  };
  for (std::size_t b = 0; b < pattern.blocks(); ++b)
    if (place_[b] >= 0) list(b, eliminated_scalars_);
  for (const std::size_t b : kept) list(b, kept_scalars_);
  if (!eliminated_scalars_.empty()) {
    inner_.emplace(inner_pattern(pattern, place_));
    cholesky_.emplace(inner_->pattern());
  }
}

Factorization PartialElimination::factorize(const SymmetricBlockMatrix& matrix) {
  const auto kept_size = static_cast<Eigen::Index>(kept_scalars_.size());
  between_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(eliminated_scalars_.size()), kept_size);
  reduced_ = Eigen::MatrixXd::Zero(kept_size, kept_size);
  if (inner_) inner_->set_zero();
  const auto kept_offset = [&](std::int32_t place) {
    return kept_offsets_[static_cast<std::size_t>(-1 - place)];
  };
  const auto inner_offset = [&](std::int32_t place) {
    return static_cast<Eigen::Index>(inner_->offset(static_cast<std::size_t>(place)));
  };
  const auto& pattern = matrix.pattern();
  for (std::size_t b = 0; b < pattern.blocks(); ++b) {
    const auto block = matrix.diagonal(b);
    if (place_[b] >= 0)
      inner_->diagonal(static_cast<std::size_t>(place_[b])) = block;
    else
      reduced_.block(kept_offset(place_[b]), kept_offset(place_[b]), block.rows(), block.cols()) =
          block.selfadjointView<Eigen::Lower>();
  }
  for (std::size_t k = 0; k < pattern.lower.size(); ++k) {
    const auto block = matrix.lower(k);
    const std::int32_t r = place_[static_cast<std::size_t>(pattern.lower[k].row)];
    const std::int32_t c = place_[static_cast<std::size_t>(pattern.lower[k].column)];
    if (r >= 0 && c >= 0)
      inner_->lower(inner_->find_lower(r, c)) = block;
    else if (r >= 0)
      between_.block(inner_offset(r), kept_offset(c), block.rows(), block.cols()) = block;
    else if (c >= 0)
      between_.block(inner_offset(c), kept_offset(r), block.cols(), block.rows()) = block.transpose();
    else {
      reduced_.block(kept_offset(r), kept_offset(c), block.rows(), block.cols()) = block;
      reduced_.block(kept_offset(c), kept_offset(r), block.cols(), block.rows()) = block.transpose();
    }
  }
  if (!inner_) return Factorization::kDone;
  if (cholesky_->factorize(*inner_) != Factorization::kDone) return Factorization::kNotPositiveDefinite;
  Eigen::MatrixXd solved(between_.rows(), between_.cols());
  for (Eigen::Index c = 0; c < between_.cols(); ++c)
    solved.col(c) =
        between_.col(c).isZero(0) ? Eigen::VectorXd(between_.col(c)) : cholesky_->solve(between_.col(c));
  const Eigen::SparseMatrix<double> sparse_between = between_.sparseView();
  reduced_ -= sparse_between.transpose() * solved;
  make_symmetric(reduced_);
  return Factorization::kDone;
}

Eigen::VectorXd PartialElimination::eliminated_part(const Eigen::VectorXd& x) const {
  return x(eliminated_scalars_);
}
Eigen::VectorXd PartialElimination::kept_part(const Eigen::VectorXd& x) const { return x(kept_scalars_); }
Eigen::VectorXd PartialElimination::solve(const Eigen::VectorXd& b) const {
  return cholesky_ ? cholesky_->solve(b) : b;
}

Eigen::VectorXd PartialElimination::reduce(const Eigen::VectorXd& b) const {
  return kept_part(b) - between_.transpose() * solve(eliminated_part(b));
}

double PartialElimination::eliminated_norm(const Eigen::VectorXd& b) const {
  const Eigen::VectorXd e = eliminated_part(b);
  return e.dot(solve(e));
}

Eigen::VectorXd PartialElimination::expand(const Eigen::VectorXd& b, const Eigen::VectorXd& kept) const {
  Eigen::VectorXd x(b.size());
  x(kept_scalars_) = kept;
  x(eliminated_scalars_) = solve(eliminated_part(b) - between_ * kept);
  return x;
}

}  // namespace radioslam
