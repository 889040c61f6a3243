// Any entries of the inverse, from a partition of the elimination tree.
//
// The fronts whose subtrees are large are separators. Each has a part: the blocks it eliminates, and the
// other blocks below it that no separator further down has. Given the part's boundary, the rows of its front,
// a block x of it is independent of everything outside (Markov property of a Gaussian with information matrix
// H):
//   x = A x_boundary + n,   Cov(x, y) = A_x Cov(boundary_x, boundary_y) A_y^T + [same part] Cov(n_x, n_y),
// and n = 0 for the blocks that the front eliminates. Where separators are small, as along trajectories, this
// takes much less than columns of the inverse, each of which costs a pass over the whole factor.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace radioslam {

struct Front;
struct FrontTree;
class NumberStore;

/// Refers to the factor it was made from. Thread-safe.
class PartitionedInverse {
 public:
  /// Parts have at most `part_scalars` scalars besides the separators'; 0: as suits the tree.
  PartitionedInverse(const FrontTree& tree, const NumberStore& factor, std::size_t part_scalars);

  std::size_t parts() const { return parts_.size(); }
  /// Of a block of the matrix.
  std::size_t part_of(std::size_t block) const;
  bool is_separator(std::size_t block) const;
  /// The part's boundary, as indices into the separators' scalars.
  const std::vector<std::uint32_t>& boundary(std::size_t part) const { return parts_[part].boundary; }
  /// Scalars of the part's blocks that are no separators.
  std::size_t part_scalars(std::size_t part) const { return parts_[part].scalars; }
  /// A^T of a block: boundary x size.
  auto by_boundary(std::size_t block) const {
    const Place at = place_of(block);
    return parts_[at.part].by_boundary.middleCols(at.column, at.size);
  }
  /// Covariances of all separators' scalars.
  const Eigen::MatrixXd& separators() const { return separators_; }
  /// Cov(n) of blocks of one part, none of them a separator, with all such blocks of it: their sizes' sum x
  /// part_scalars. A block's columns begin at local_column.
  Eigen::MatrixXd local_rows(const std::vector<std::size_t>& blocks) const;
  Eigen::Index local_column(std::size_t block) const { return place_of(block).column; }

 private:
  struct Part {
    std::vector<std::uint32_t> fronts;  ///< that are no separators, children before parents
    std::vector<std::uint32_t> boundary;
    std::size_t scalars = 0, pivots = 0;  ///< of those fronts; of the separator
    Eigen::MatrixXd by_boundary;          ///< A^T of the part's own scalars, then of its separator's
  };
  struct Place {
    std::size_t part = 0;
    Eigen::Index column = 0, size = 0;
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  Place place_of(std::size_t block) const;
  void find_parts(std::size_t part_scalars);
  void number_scalars();
  void find_boundaries();
  void find_maps();
  void find_map(Part& part) const;
  void invert_separators();
  Eigen::MatrixXd separator_rows(std::size_t first, std::size_t last) const;

  const FrontTree& tree_;
  const NumberStore& factor_;
  std::vector<bool> is_separator_;   ///< per front
  std::vector<std::uint32_t> part_;  ///< per front
  std::vector<Part> parts_;
  std::vector<std::uint32_t> column_;     ///< per scalar in elimination order: in its part's by_boundary
  std::vector<std::uint32_t> separator_;  ///< per scalar in elimination order: in `separators_`, or kNone
  std::vector<std::uint32_t> separator_fronts_;
  Eigen::MatrixXd separators_;
};

}  // namespace radioslam
