#include "radioslam/graph/linear/block_matrix.hpp"

#include <algorithm>
#include <tuple>

#include "radioslam/base/check.hpp"

namespace radioslam {

SymmetricBlockMatrix::SymmetricBlockMatrix(BlockPattern pattern) : pattern_(std::move(pattern)) {
  std::size_t scalars = 0;
  for (const auto size : pattern_.sizes) {
    RADIOSLAM_CHECK(size > 0, "a block needs rows");
    const auto n = static_cast<std::size_t>(size);
    offsets_.push_back(rows_);
    diagonal_starts_.push_back(scalars);
    rows_ += n;
    scalars += n * n;
  }
  for (const auto& [row, column] : pattern_.lower) {
    RADIOSLAM_CHECK(column < row, "blocks must be below the diagonal");
    lower_starts_.push_back(scalars);
    scalars += static_cast<std::size_t>(pattern_.sizes[static_cast<std::size_t>(row)]) *
               static_cast<std::size_t>(pattern_.sizes[static_cast<std::size_t>(column)]);
  }
  values_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scalars));
}

void SymmetricBlockMatrix::set_zero() { values_.setZero(); }

SymmetricBlockMatrix::Block SymmetricBlockMatrix::diagonal(std::size_t i) {
  return {values_.data() + diagonal_starts_[i], pattern_.sizes[i], pattern_.sizes[i]};
}

SymmetricBlockMatrix::ConstBlock SymmetricBlockMatrix::diagonal(std::size_t i) const {
  return {values_.data() + diagonal_starts_[i], pattern_.sizes[i], pattern_.sizes[i]};
}

SymmetricBlockMatrix::Block SymmetricBlockMatrix::lower(std::size_t k) {
  const auto [row, column] = pattern_.lower[k];
  return {values_.data() + lower_starts_[k], pattern_.sizes[static_cast<std::size_t>(row)],
          pattern_.sizes[static_cast<std::size_t>(column)]};
}

SymmetricBlockMatrix::ConstBlock SymmetricBlockMatrix::lower(std::size_t k) const {
  const auto [row, column] = pattern_.lower[k];
  return {values_.data() + lower_starts_[k], pattern_.sizes[static_cast<std::size_t>(row)],
          pattern_.sizes[static_cast<std::size_t>(column)]};
}

std::size_t SymmetricBlockMatrix::find_lower(std::int32_t row, std::int32_t column) const {
  const auto& lower = pattern_.lower;
  const auto found = std::lower_bound(lower.begin(), lower.end(), BlockPlace{row, column},
                                      [](const BlockPlace& a, const BlockPlace& b) {
                                        return std::tie(a.column, a.row) < std::tie(b.column, b.row);
                                      });
  RADIOSLAM_CHECK(found != lower.end() && found->row == row && found->column == column,
                  "the block is not in the pattern");
  return static_cast<std::size_t>(found - lower.begin());
}

}  // namespace radioslam
