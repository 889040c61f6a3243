// The normal equations of a pose graph: H = sum w J^T Omega J, g = sum w J^T Omega r, with w the factor's
// weight times its loss's (iteratively reweighted least squares, first order).
// The structure (blocks, ordering, elimination tree) is found once; linearising again costs numbers only.
// Gauge: see gauge.hpp. Drifts, tied to every pose of a robot, are eliminated last.
#pragma once

#include <memory>
#include <tuple>
#include <vector>

#include "radioslam/graph/block_structure.hpp"
#include "radioslam/graph/factor_sums.hpp"
#include "radioslam/graph/gauge.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"

namespace radioslam {

template <class Pose>
class NormalEquations {
 public:
  explicit NormalEquations(const PoseGraph<Pose>& graph);

  /// No free variable or no factor.
  bool empty() const { return matrix_.rows() == 0; }

  /// Fills H and g at the graph's values; returns the cost there. The graph must have the structure of the
  /// one given to the constructor: values, measurements, informations, weights and losses may differ.
  double linearise(const PoseGraph<Pose>& graph);

  /// Factorises H + damping * diag(H); an empty diagonal entry counts as a small fraction of the largest.
  Factorization factorize(double damping);
  /// The step that solves (H + damping * diag(H)) step = -g.
  Eigen::VectorXd step() const { return cholesky_->solve(-gradient_); }
  /// Cost decrease of the step predicted by the quadratic model: -g^T step.
  double predicted_decrease(const Eigen::VectorXd& step) const { return -gradient_.dot(step); }
  /// Moves the graph's values by a step.
  void apply(const Eigen::VectorXd& step, PoseGraph<Pose>& graph) const;

  const VariableBlocks& blocks() const { return blocks_; }
  const SymmetricBlockMatrix& matrix() const { return matrix_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }
  const BlockCholesky& cholesky() const { return *cholesky_; }

 private:
  template <class Factor>
  struct List {
    std::vector<FactorSlots<std::tuple_size_v<decltype(variables(std::declval<const Factor&>()))>>> slots;
    std::vector<SumsOf<Pose, Factor>> wave;  ///< the sums of the factors that are being linearised
  };
  using Lists = std::tuple<List<RelativePoseFactor<Pose>>, List<RangeFactor<Pose>>, List<BearingFactor<Pose>>,
                           List<RelativePointFactor<Pose>>, List<PositionFactor<Pose>>,
                           List<PosePriorFactor<Pose>>, List<DriftPriorFactor>, List<RangeBiasPriorFactor>>;

  template <class Factor>
  double linearise_list(const PoseGraph<Pose>& graph, const std::vector<Factor>& factors, List<Factor>& list);
  void add_gauge_penalties();

  Gauge<Pose> gauge_;
  VariableBlocks blocks_;
  SymmetricBlockMatrix matrix_;
  Lists lists_;
  Eigen::VectorXd gradient_, diagonal_;
  std::unique_ptr<BlockCholesky> cholesky_;
};

}  // namespace radioslam
