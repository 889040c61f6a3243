// The normal equations of a pose graph: H = sum w J^T Omega J, g = sum w J^T Omega r, with w the factor's
// weight times its loss's (iteratively reweighted least squares, first order).
// The structure (blocks, ordering, elimination tree) is found once; linearising again costs numbers only.
// Gauge: see gauge.hpp. Drifts, tied to every pose of a robot, are eliminated last.
#pragma once

#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "radioslam/graph/block_structure.hpp"
#include "radioslam/graph/gauge.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"
#include "radioslam/graph/linearisation.hpp"
#include "radioslam/graph/loss.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {

// What a factor adds to the cost, to g and to the blocks of H; see normal_equations.hpp.

/// Calls body(std::integral_constant<std::size_t, k>{}) for k = 0, ..., K - 1.
template <std::size_t K, class Body>
void for_each_index(Body&& body) {
  [&]<std::size_t... k>(std::index_sequence<k...>) { (body(std::integral_constant<std::size_t, k>{}), ...); }
  (std::make_index_sequence<K>{});
}

/// The pairs (a, b) with a < b of up to three variables, in the order of FactorSlots::lower.
template <std::size_t K, std::size_t pair>
inline constexpr std::pair<std::size_t, std::size_t> kPair =
    pair == 0 ? std::pair<std::size_t, std::size_t>{0, 1} : std::pair<std::size_t, std::size_t>{pair - 1, 2};

/// Blocks of one factor; `lower` holds, per pair, the one below the diagonal of H.
template <int... Columns>
struct FactorSums;

template <int A>
struct FactorSums<A> {
  double cost = 0;
  std::tuple<Eigen::Matrix<double, A, 1>> gradient;
  std::tuple<Eigen::Matrix<double, A, A>> diagonal;
  std::tuple<> lower;
};
template <int A, int B>
struct FactorSums<A, B> {
  double cost = 0;
  std::tuple<Eigen::Matrix<double, A, 1>, Eigen::Matrix<double, B, 1>> gradient;
  std::tuple<Eigen::Matrix<double, A, A>, Eigen::Matrix<double, B, B>> diagonal;
  std::tuple<Eigen::Matrix<double, B, A>> lower;
};
template <int A, int B, int C>
struct FactorSums<A, B, C> {
  double cost = 0;
  std::tuple<Eigen::Matrix<double, A, 1>, Eigen::Matrix<double, B, 1>, Eigen::Matrix<double, C, 1>> gradient;
  std::tuple<Eigen::Matrix<double, A, A>, Eigen::Matrix<double, B, B>, Eigen::Matrix<double, C, C>> diagonal;
  std::tuple<Eigen::Matrix<double, B, A>, Eigen::Matrix<double, C, A>, Eigen::Matrix<double, C, B>> lower;
};

template <int Rows, int... Columns>
FactorSums<Columns...> sums_type(const Linearisation<Rows, Columns...>&);

/// The sums of a factor type in graphs of a pose type.
template <class Pose, class Factor>
using SumsOf =
    decltype(sums_type(linearise(std::declval<const PoseGraph<Pose>&>(), std::declval<const Factor&>())));

/// Computes a factor's sums; parts whose variable is left out stay unset.
template <class Pose, class Factor, std::size_t K>
void compute_sums(const PoseGraph<Pose>& graph, const Factor& factor, const FactorSlots<K>& slots,
                  SumsOf<Pose, Factor>& sums) {
  const auto linear = linearise(graph, factor);
  const auto& omega = information(factor);
  const auto weighted_residual = (omega * linear.residual).eval();
  const LossValue value = evaluate(loss(factor), weight(factor) * linear.residual.dot(weighted_residual));
  const double w = weight(factor) * value.weight;
  sums.cost = value.cost;
  auto weighted_jacobians = linear.jacobians;  // w Omega J_k
  for_each_index<K>([&](auto k) {
    if (slots.blocks[k] < 0) return;
    const auto& j = std::get<k>(linear.jacobians);
    auto& wj = std::get<k>(weighted_jacobians);
    wj.noalias() = (w * omega).lazyProduct(j);
    std::get<k>(sums.gradient).noalias() = w * (j.transpose() * weighted_residual);
    std::get<k>(sums.diagonal).noalias() = j.transpose().lazyProduct(wj);
  });
  for_each_index<K*(K - 1) / 2>([&](auto pair) {
    if (slots.lower[pair] < 0) return;
    constexpr std::size_t a = kPair<K, pair>.first, b = kPair<K, pair>.second;
    const auto& j_a = std::get<a>(linear.jacobians);
    const auto& j_b = std::get<b>(linear.jacobians);
    auto& block = std::get<pair>(sums.lower);
    if constexpr (std::is_same_v<decltype(j_a), decltype(j_b)>) {
      if (slots.blocks[a] > slots.blocks[b]) {
        block.noalias() = j_a.transpose().lazyProduct(std::get<b>(weighted_jacobians));
        return;
      }
    }
    block.noalias() = j_b.transpose().lazyProduct(std::get<a>(weighted_jacobians));
  });
}

/// target += the part of `sum` that belongs to it: a point's block is smaller than a pose's.
template <class Sum>
void add_to_block(SymmetricBlockMatrix::Block target, const Sum& sum) {
  constexpr int kRows = Sum::RowsAtCompileTime, kColumns = Sum::ColsAtCompileTime;
  if (target.rows() == kRows && target.cols() == kColumns)
    Eigen::Map<Eigen::Matrix<double, kRows, kColumns>>(target.data()) += sum;
  else
    target += sum.topLeftCorner(target.rows(), target.cols());
}

/// Adds a factor's sums to H and g at its slots.
template <std::size_t K, class Sums>
void add_sums(const Sums& sums, const FactorSlots<K>& slots, SymmetricBlockMatrix& matrix,
              Eigen::VectorXd& gradient) {
  for_each_index<K>([&](auto k) {
    if (slots.blocks[k] < 0) return;
    const auto block = static_cast<std::size_t>(slots.blocks[k]);
    const auto target = matrix.diagonal(block);
    add_to_block(target, std::get<k>(sums.diagonal));
    gradient.segment(static_cast<Eigen::Index>(matrix.offset(block)), target.rows()) +=
        std::get<k>(sums.gradient).head(target.rows());
  });
  for_each_index<K*(K - 1) / 2>([&](auto pair) {
    if (slots.lower[pair] >= 0)
      add_to_block(matrix.lower(static_cast<std::size_t>(slots.lower[pair])), std::get<pair>(sums.lower));
  });
}

template <class Pose>
class NormalEquations {
 public:
  explicit NormalEquations(const PoseGraph<Pose>& graph);
  /// With another gauge than the graph's own. Where it leaves directions free, as in a part of a larger
  /// system, the matrix is singular and only to be eliminated in part.
  NormalEquations(const PoseGraph<Pose>& graph, Gauge<Pose> gauge);

  /// No free variable or no factor.
  bool empty() const { return matrix_.rows() == 0; }

  /// Fills H and g at the graph's values; returns the cost there. The graph must have the structure of the
  /// one given to the constructor: values, measurements, informations, weights and losses may differ.
  double linearise(const PoseGraph<Pose>& graph);

  /// Makes the matrix H + damping * diag(H); an empty diagonal entry counts as a small fraction of the
  /// largest.
  void damp(double damping);
  /// Factorises H + damping * diag(H).
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
  /// Once it has been factorised.
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
