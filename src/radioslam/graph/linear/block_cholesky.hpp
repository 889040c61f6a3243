// Block multifrontal Cholesky factorisation of a sparse symmetric positive definite matrix, and selected
// inversion on the same factor.
// Source: Duff and Reid 1983 (multifrontal); Liu 1992 (survey); Erisman and Tinney 1975 (selected inverse).
// The analysis (ordering, elimination tree, supernodes, slots) is done once per pattern; factorising again
// with other values costs numbers only. Single use by one thread at a time; same bytes on every run.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "radioslam/graph/linear/block_matrix.hpp"
#include "radioslam/graph/linear/partitioned_inverse.hpp"

namespace radioslam {

/// How the blocks are ordered before elimination.
enum class Ordering {
  kBest,     ///< the cheaper of the two by predicted floating-point operations; METIS is tried only where
             ///< a factorisation takes long enough to repay it
  kAmd,      ///< approximate minimum degree
  kMetis,    ///< nested dissection
  kNatural,  ///< as given; for tests
};

struct BlockCholeskyOptions {
  Ordering ordering = Ordering::kBest;
  /// Blocks eliminated last in any ordering: variables connected to nearly all others.
  std::vector<std::int32_t> last;
};

enum class Factorization { kDone, kNotPositiveDefinite };

/// Selected entries of the inverse: at least every block of the factor's pattern.
class SelectedInverse {
 public:
  /// Covariance block (i, i).
  Eigen::MatrixXd diagonal(std::size_t i) const;
  /// Covariance block (i, j) where the factor has it; nothing elsewhere (then solve for it).
  std::optional<Eigen::MatrixXd> block(std::size_t i, std::size_t j) const;

  struct Impl;
  explicit SelectedInverse(std::shared_ptr<const Impl> impl);

 private:
  std::shared_ptr<const Impl> impl_;
};

class BlockCholesky {
 public:
  BlockCholesky(const BlockPattern& pattern, const BlockCholeskyOptions& options = {});
  ~BlockCholesky();
  BlockCholesky(BlockCholesky&&) noexcept;
  BlockCholesky& operator=(BlockCholesky&&) noexcept;

  /// P H P^T = L L^T. After kNotPositiveDefinite the factor cannot be used.
  Factorization factorize(const SymmetricBlockMatrix& matrix);
  /// H^-1 b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Columns of H^-1 for block j: rows() x sizes[j].
  Eigen::MatrixXd inverse_columns(std::size_t j) const { return inverse_rows({j}).transpose(); }
  /// Rows of H^-1 for blocks: their sizes' sum x rows(). Some dozen rows at once take a fraction of the time
  /// of one after the other. May be called from several threads.
  Eigen::MatrixXd inverse_rows(const std::vector<std::size_t>& blocks) const;
  /// H^-1 between these blocks, in their order: their sizes' sum, squared. Visits only what is on the way
  /// from them to the root of the elimination tree.
  Eigen::MatrixXd inverse_between(const std::vector<std::size_t>& blocks) const;
  /// log det H.
  double log_determinant() const;
  SelectedInverse selected_inverse() const;
  /// Valid until this is factorised again. `part_scalars`: size of its parts; 0: as suits the matrix.
  PartitionedInverse partitioned_inverse(std::size_t part_scalars = 0) const;

  /// Predicted by the analysis.
  double factor_flops() const;
  std::size_t factor_scalars() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace radioslam
