// A sparse symmetric matrix of small dense blocks: the normal equations of a pose graph.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace radioslam {

/// The place of a block below the diagonal: row > column.
struct BlockPlace {
  std::int32_t row = 0;
  std::int32_t column = 0;
  auto operator<=>(const BlockPlace&) const = default;
};

/// Which blocks there are. Every diagonal block is there; `lower` lists the others once each, sorted by
/// (column, row).
struct BlockPattern {
  std::vector<std::int32_t> sizes;  ///< rows of block i, each at least 1
  std::vector<BlockPlace> lower;

  std::size_t blocks() const { return sizes.size(); }
};

/// Values over a pattern; column-major blocks. Only the lower triangle is stored, and of a diagonal block
/// only the lower triangle is read.
class SymmetricBlockMatrix {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd>;

  explicit SymmetricBlockMatrix(BlockPattern pattern);

  const BlockPattern& pattern() const { return pattern_; }
  std::size_t rows() const { return rows_; }
  /// First scalar row of block i.
  std::size_t offset(std::size_t i) const { return offsets_[i]; }

  void set_zero();
  Block diagonal(std::size_t i);
  ConstBlock diagonal(std::size_t i) const;
  /// The k-th block of pattern().lower, sizes[row] x sizes[column].
  Block lower(std::size_t k);
  ConstBlock lower(std::size_t k) const;
  /// Index into pattern().lower; aborts when the block is not in the pattern.
  std::size_t find_lower(std::int32_t row, std::int32_t column) const;

 private:
  BlockPattern pattern_;
  std::size_t rows_ = 0;
  std::vector<std::size_t> offsets_;
  std::vector<std::size_t> diagonal_starts_, lower_starts_;
  Eigen::VectorXd values_;
};

}  // namespace radioslam
