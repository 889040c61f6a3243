// Linear least squares over the poses of a graph: one d x m matrix X_p per pose, one term per relative pose,
//   min sum |X_j - A X_i - B|^2_W,
// column by column, some poses held at given values. Both steps of the chordal initialisation are of this
// kind; a robot of a team solves its part of them with the poses of others held.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "radioslam/graph/block_structure.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

template <int D>
struct NetworkTerm {
  Eigen::Matrix<double, D, D> a, b, w;  ///< of b the first m columns count
};

template <class Pose>
using PoseMatrix = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;
/// One per pose or factor of a graph.
template <class Pose>
using PoseMatrices = std::vector<PoseMatrix<Pose>>;
template <class Pose>
using NetworkTerms = std::vector<NetworkTerm<Pose::kDim>>;

/// The structure is analysed once, for any number of terms; the matrix is factorised once per terms, for any
/// number of held values.
template <class Pose>
class PoseNetworkSolver {
 public:
  PoseNetworkSolver(const PoseGraph<Pose>& graph, const std::vector<bool>& held);

  /// One term per relative pose of the graph; false when the problem is singular.
  bool set_terms(NetworkTerms<Pose> terms);
  /// `values` holds X_p in its first `columns` columns; those of poses that are not held are not read.
  /// Nothing when the solution is not finite.
  std::optional<PoseMatrices<Pose>> solve(Eigen::Index columns, PoseMatrices<Pose> values);
  /// The sum at some values.
  double cost(Eigen::Index columns, const PoseMatrices<Pose>& values) const;

 private:
  void add_to_matrix(std::size_t factor);
  void add_to_right_side(std::size_t factor, const PoseMatrices<Pose>& values);

  std::vector<std::array<std::size_t, 2>> ends_;  ///< i and j of every relative pose
  VariableBlocks blocks_;
  SymmetricBlockMatrix matrix_;
  std::vector<FactorSlots<2>> slots_;
  NetworkTerms<Pose> terms_;
  Eigen::MatrixXd right_side_;
  std::optional<BlockCholesky> cholesky_;
};

/// Terms of the transposed rotations, X_j = R_ij^T X_i, on matrices that need not be rotations.
template <class Pose>
NetworkTerms<Pose> rotation_terms(const PoseGraph<Pose>& graph);
/// Terms of the translations, in the first columns, given the rotation of every pose.
template <class Pose>
NetworkTerms<Pose> translation_terms(const PoseGraph<Pose>& graph, const PoseMatrices<Pose>& rotations);

Eigen::Matrix2d nearest_rotation(const Eigen::Matrix2d& m);
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m);
SE2 make_pose(const Eigen::Vector2d& translation, const Eigen::Matrix2d& rotation);
SE3 make_pose(const Eigen::Vector3d& translation, const Eigen::Matrix3d& rotation);

}  // namespace radioslam
