// Random sparse symmetric positive definite block matrices, and the same as dense ones.
#pragma once

#include <Eigen/Core>
#include <set>

#include "radioslam/base/random.hpp"
#include "radioslam/graph/linear/block_matrix.hpp"

namespace radioslam::test {

struct RandomPatternParams {
  std::size_t blocks = 30;
  std::size_t extra_edges = 40;
  std::vector<std::int32_t> sizes{6};  ///< drawn from
  double chain_ratio = 0.9;            ///< of successive blocks that touch
};

inline BlockPattern pattern_of(std::vector<std::int32_t> sizes, const std::set<std::pair<int, int>>& edges) {
  BlockPattern pattern{std::move(sizes), {}};
  for (const auto& [column, row] : edges) pattern.lower.push_back({row, column});
  return pattern;
}

inline BlockPattern random_pattern(Rng& rng, const RandomPatternParams& params) {
  std::vector<std::int32_t> sizes;
  std::set<std::pair<int, int>> edges;
  for (std::size_t i = 0; i < params.blocks; ++i) {
    sizes.push_back(params.sizes[rng.below(params.sizes.size())]);
    if (i > 0 && rng.uniform() < params.chain_ratio)
      edges.emplace(static_cast<int>(i) - 1, static_cast<int>(i));
  }
  for (std::size_t e = 0; e < params.extra_edges && params.blocks > 1; ++e) {
    const auto a = static_cast<int>(rng.below(params.blocks)), b = static_cast<int>(rng.below(params.blocks));
    if (a != b) edges.emplace(std::min(a, b), std::max(a, b));
  }
  return pattern_of(std::move(sizes), edges);
}

/// Random blocks with a diagonal that dominates just enough.
inline SymmetricBlockMatrix random_matrix(Rng& rng, const BlockPattern& pattern) {
  SymmetricBlockMatrix matrix(pattern);
  Eigen::VectorXd row_sums = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(matrix.rows()), 0.1);
  const auto offset = [&](std::int32_t i) {
    return static_cast<Eigen::Index>(matrix.offset(static_cast<std::size_t>(i)));
  };
  for (std::size_t k = 0; k < pattern.lower.size(); ++k) {
    auto block = matrix.lower(k);
    block = block.unaryExpr([&](double) { return rng.uniform(-1, 1); });
    row_sums.segment(offset(pattern.lower[k].row), block.rows()) += block.cwiseAbs().rowwise().sum();
    row_sums.segment(offset(pattern.lower[k].column), block.cols()) +=
        block.cwiseAbs().colwise().sum().transpose();
  }
  for (std::size_t i = 0; i < pattern.blocks(); ++i) {
    auto block = matrix.diagonal(i);
    const Eigen::MatrixXd part = block.unaryExpr([&](double) { return rng.uniform(-1, 1); });
    block = part * part.transpose();
    block.diagonal() += row_sums.segment(offset(static_cast<std::int32_t>(i)), block.rows());
    // The upper triangle is never read.
    block.triangularView<Eigen::StrictlyUpper>().setConstant(1e9);
  }
  return matrix;
}

inline Eigen::MatrixXd dense(const SymmetricBlockMatrix& matrix) {
  const auto n = static_cast<Eigen::Index>(matrix.rows());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  const auto& pattern = matrix.pattern();
  const auto offset = [&](std::int32_t i) {
    return static_cast<Eigen::Index>(matrix.offset(static_cast<std::size_t>(i)));
  };
  for (std::size_t i = 0; i < pattern.blocks(); ++i) {
    const auto block = matrix.diagonal(i);
    const auto at = static_cast<Eigen::Index>(matrix.offset(i));
    result.block(at, at, block.rows(), block.cols()) = block;
  }
  for (std::size_t k = 0; k < pattern.lower.size(); ++k) {
    const auto block = matrix.lower(k);
    result.block(offset(pattern.lower[k].row), offset(pattern.lower[k].column), block.rows(), block.cols()) =
        block;
  }
  return result.selfadjointView<Eigen::Lower>();
}

}  // namespace radioslam::test
