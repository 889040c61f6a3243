#include "radioslam/graph/normal_equations.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

/// Value of an empty diagonal entry for damping, relative to the largest one.
constexpr double kEmptyDiagonalRatio = 1e-9;
/// Number of factors whose sums are computed in parallel before they are added in order, and the number per
/// task.
constexpr std::size_t kWave = 2048, kGrain = 256;

/// Drifts and biases touch many poses.
BlockCholeskyOptions shared_last(const VariableBlocks& blocks) {
  BlockCholeskyOptions options;
  for (const auto& list : {blocks.drifts, blocks.biases})
    for (const auto block : list)
      if (block >= 0) options.last.push_back(block);
  return options;
}

}  // namespace

template <class Pose>
NormalEquations<Pose>::NormalEquations(const PoseGraph<Pose>& graph)
    : NormalEquations(graph, resolve_gauge(graph)) {}

template <class Pose>
NormalEquations<Pose>::NormalEquations(const PoseGraph<Pose>& graph, Gauge<Pose> gauge)
    : gauge_(std::move(gauge)),
      blocks_(number_blocks(graph, gauge_.held)),
      matrix_(block_pattern(graph, blocks_)) {
  gradient_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(matrix_.rows()));
  const auto factors = factor_lists(graph);
  static_assert(std::tuple_size_v<Lists> == std::tuple_size_v<decltype(factors)>,
                "every factor has its list");
  for_each_index<std::tuple_size_v<Lists>>([&](auto k) {
    auto& list = std::get<k>(lists_);
    for (const auto& factor : std::get<k>(factors))
      list.slots.push_back(factor_slots(matrix_, blocks_, variables(factor)));
    list.wave.resize(std::min(kWave, list.slots.size()));
  });
}

template <class Pose>
double NormalEquations<Pose>::linearise(const PoseGraph<Pose>& graph) {
  matrix_.set_zero();
  gradient_.setZero();
  double cost = 0;
  const auto factors = factor_lists(graph);
  for_each_index<std::tuple_size_v<Lists>>(
      [&](auto k) { cost += linearise_list(graph, std::get<k>(factors), std::get<k>(lists_)); });
  add_gauge_penalties();
  diagonal_.resize(gradient_.size());
  for (std::size_t b = 0; b < matrix_.pattern().blocks(); ++b) {
    const auto block = matrix_.diagonal(b);
    diagonal_.segment(static_cast<Eigen::Index>(matrix_.offset(b)), block.rows()) = block.diagonal();
  }
  return cost;
}

template <class Pose>
template <class Factor>
double NormalEquations<Pose>::linearise_list(const PoseGraph<Pose>& graph, const std::vector<Factor>& factors,
                                             List<Factor>& list) {
  RADIOSLAM_CHECK(factors.size() == list.slots.size(), "the graph's structure has changed");
  double cost = 0;
  for (std::size_t start = 0; start < factors.size(); start += kWave) {
    const std::size_t count = std::min(kWave, factors.size() - start);
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        compute_sums(graph, factors[start + i], list.slots[start + i], list.wave[i]);
    });
    for (std::size_t i = 0; i < count; ++i) {
      cost += list.wave[i].cost;
      add_sums(list.wave[i], list.slots[start + i], matrix_, gradient_);
    }
  }
  return cost;
}

template <class Pose>
void NormalEquations<Pose>::add_gauge_penalties() {
  for (const auto& [pose, penalty] : gauge_.penalties)
    matrix_.diagonal(static_cast<std::size_t>(blocks_.poses[pose.index()])) += penalty;
}

template <class Pose>
void NormalEquations<Pose>::damp(double damping) {
  if (empty()) return;
  const double least = kEmptyDiagonalRatio * diagonal_.maxCoeff();
  for (std::size_t b = 0; b < matrix_.pattern().blocks(); ++b) {
    auto block = matrix_.diagonal(b);
    const auto d = diagonal_.segment(static_cast<Eigen::Index>(matrix_.offset(b)), block.rows());
    block.diagonal() = d + damping * d.cwiseMax(least);
  }
}

template <class Pose>
Factorization NormalEquations<Pose>::factorize(double damping) {
  if (!cholesky_) cholesky_ = std::make_unique<BlockCholesky>(matrix_.pattern(), shared_last(blocks_));
  damp(damping);
  return cholesky_->factorize(matrix_);
}

template <class Pose>
void NormalEquations<Pose>::apply(const Eigen::VectorXd& step, PoseGraph<Pose>& graph) const {
  const auto part = [&](std::int32_t block, auto size) {
    const auto offset = static_cast<Eigen::Index>(matrix_.offset(static_cast<std::size_t>(block)));
    return step.segment<size.value>(offset);
  };
  for (std::size_t i = 0; i < graph.poses.size(); ++i)
    if (blocks_.poses[i] >= 0)
      graph.poses[i] =
          graph.poses[i] * Pose::exp(part(blocks_.poses[i], std::integral_constant<int, Pose::kDof>{}));
  for (std::size_t i = 0; i < graph.points.size(); ++i)
    if (blocks_.points[i] >= 0)
      graph.points[i] += part(blocks_.points[i], std::integral_constant<int, Pose::kDim>{});
  for (std::size_t i = 0; i < graph.drifts.size(); ++i)
    if (blocks_.drifts[i] >= 0) graph.drifts[i] += part(blocks_.drifts[i], std::integral_constant<int, 2>{});
  for (std::size_t i = 0; i < graph.range_biases.size(); ++i)
    if (blocks_.biases[i] >= 0)
      graph.range_biases[i] += part(blocks_.biases[i], std::integral_constant<int, 1>{})[0];
}

template class NormalEquations<SE2>;
template class NormalEquations<SE3>;

}  // namespace radioslam
