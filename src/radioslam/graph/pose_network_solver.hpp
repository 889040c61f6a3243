// Linear least squares over the poses of a graph: one d x m matrix X_p per pose, one term per relative
// pose, min sum |X_j - A X_i - B|^2_W, column by column. Some poses are held at given values.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/graph/block_structure.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"

namespace radioslam {

template <int D>
struct NetworkTerm {
  Eigen::Matrix<double, D, D> a, b, w;  ///< of b the first m columns count
};

/// The structure is analysed once, for any number of solves.
template <class Pose>
class PoseNetworkSolver {
 public:
  using Matrix = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;
  using Term = NetworkTerm<Pose::kDim>;

  PoseNetworkSolver(const PoseGraph<Pose>& graph, const std::vector<bool>& held);

  /// `values` holds X_p in its first `columns` columns; `terms` one per relative pose. Nothing when the
  /// problem is singular.
  std::optional<std::vector<Matrix>> solve(Eigen::Index columns, std::vector<Matrix> values,
                                           const std::vector<Term>& terms);

 private:
  void add_term(std::size_t factor, const Term& term, const std::vector<Matrix>& values);

  std::vector<std::array<std::size_t, 2>> ends_;  ///< i and j of every relative pose
  VariableBlocks blocks_;
  SymmetricBlockMatrix matrix_;
  std::vector<FactorSlots<2>> slots_;
  Eigen::MatrixXd right_side_;
  std::optional<BlockCholesky> cholesky_;
};

}  // namespace radioslam
