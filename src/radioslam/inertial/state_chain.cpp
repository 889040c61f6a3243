#include "radioslam/inertial/state_chain.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

using Block = InertialState::Jacobian;

auto lower(const Block& block) { return block.triangularView<Eigen::Lower>(); }

}  // namespace

Block ChainCovariance::between(std::size_t i, std::size_t j) const {
  RADIOSLAM_CHECK(i <= j && j < size(), "states of the chain, in order");
  Block block = of_states_[j];
  for (std::size_t k = j; k-- > i;) block = (by_next_[k] * block).eval();
  return block;
}

std::optional<ChainFactor> ChainFactor::compute(const ChainMatrix& matrix, double damping) {
  ChainFactor factor;
  factor.lower_.reserve(matrix.diagonal.size());
  factor.coupling_.reserve(matrix.below.size());
  for (std::size_t k = 0; k < matrix.diagonal.size(); ++k) {
    Block rest = matrix.diagonal[k];
    rest.diagonal() *= 1 + damping;
    if (k > 0) {
      factor.coupling_.push_back(
          lower(factor.lower_.back()).solve(matrix.below[k - 1].transpose()).transpose());
      rest.noalias() -= factor.coupling_.back() * factor.coupling_.back().transpose();
    }
    const Cholesky<Block> cholesky(rest);
    if (!cholesky.succeeded()) return std::nullopt;
    factor.lower_.push_back(cholesky.lower());
  }
  return factor;
}

std::vector<InertialState::Tangent> ChainFactor::solve(std::vector<InertialState::Tangent> b) const {
  for (std::size_t k = 0; k < b.size(); ++k) {
    if (k > 0) b[k] -= coupling_[k - 1] * b[k - 1];
    lower(lower_[k]).solveInPlace(b[k]);
  }
  for (std::size_t k = b.size(); k-- > 0;) {
    if (k + 1 < b.size()) b[k] -= coupling_[k].transpose() * b[k + 1];
    lower_[k].transpose().triangularView<Eigen::Upper>().solveInPlace(b[k]);
  }
  return b;
}

ChainCovariance ChainFactor::covariance() const {
  std::vector<Block> of_states(lower_.size()), by_next(coupling_.size());
  for (std::size_t k = lower_.size(); k-- > 0;) {
    const Block inverse = lower(lower_[k]).solve(Block::Identity());
    of_states[k] = inverse.transpose() * inverse;
    if (k == coupling_.size()) continue;
    by_next[k] = -inverse.transpose() * coupling_[k].transpose();
    of_states[k] += by_next[k] * of_states[k + 1] * by_next[k].transpose();
  }
  return {std::move(of_states), std::move(by_next)};
}

}  // namespace radioslam
