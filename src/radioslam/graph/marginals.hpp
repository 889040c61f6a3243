// Marginal covariances of a graph's variables at its current values, from the inverse of the normal
// equations' matrix H: all diagonal blocks by selected inversion on one factorisation, pairs from the same
// entries where the factor has them and by solving otherwise.
// Poses: for the right perturbation [translation, rotation] in the graph's own units (m, rad). Robust losses
// count with their weight at the current residual. Held poses (gauge.hpp) have covariance zero, so all
// covariances are relative to them; with a gauge penalty, unobservable directions have the penalty's
// covariance. Points, drifts and biases that no factor touches have an infinite variance.
#pragma once

#include <optional>

#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

template <class Pose>
class Marginals {
 public:
  using PoseCovariance = typename Pose::Jacobian;
  using PointCovariance = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;
  using PoseColumns = Eigen::Matrix<double, Pose::kDof, Eigen::Dynamic>;

  /// Nothing when H is singular: something in the graph is not observed. Parts that hang together by next to
  /// nothing are singular up to rounding; damping then states them more certain than they are.
  static std::optional<Marginals> compute(const PoseGraph<Pose>& graph);

  PoseCovariance pose(PoseId i) const { return block(variable(i), variable(i)); }
  PointCovariance point(PointId i) const { return block(variable(i), variable(i)); }
  Eigen::Matrix2d drift(DriftId i) const { return block(variable(i), variable(i)); }
  /// Variance.
  double range_bias_m2(BiasId i) const { return block(variable(i), variable(i))(0, 0); }

  /// Covariance of [a; b], for different variables.
  Eigen::MatrixXd joint(const Variable& a, const Variable& b) const;

  /// Covariance of T_i_j = T_i^-1 T_j for a right perturbation.
  PoseCovariance relative_pose(PoseId i, PoseId j) const;
  /// The same of this pose with each of the graph's, T_i_j with i before j: at the cost of one solution. Zero
  /// for the pose itself.
  std::vector<PoseCovariance> relative_poses_with(PoseId i) const;
  /// The same for all pairs of these poses, (0, 1), (0, 2), ..., (1, 2), ...: for many pairs, at the cost of
  /// one solution for each pose.
  std::vector<PoseCovariance> relative_poses(const std::vector<PoseId>& of) const;
  /// Covariance of each of these poses with the linear functions sum_k coefficients[k]^T xi_k of all of them,
  /// a column each: at the cost of one solution for each function.
  std::vector<PoseColumns> with_functions(const std::vector<PoseId>& of,
                                          const std::vector<PoseColumns>& coefficients) const;

 private:
  Marginals(NormalEquations<Pose> equations, std::optional<SelectedInverse> inverse, std::vector<Pose> poses)
      : equations_(std::move(equations)), inverse_(std::move(inverse)), poses_(std::move(poses)) {}

  PoseCovariance relative_pose(PoseId i, PoseId j, const PoseCovariance& of_i, const PoseCovariance& of_j,
                               const PoseCovariance& of_i_with_j) const;
  /// The covariance of a with b.
  Eigen::MatrixXd block(const Variable& a, const Variable& b) const;

  NormalEquations<Pose> equations_;
  std::optional<SelectedInverse> inverse_;  ///< nothing when no variable is free
  std::vector<Pose> poses_;
};

}  // namespace radioslam
