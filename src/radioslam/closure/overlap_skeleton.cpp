#include "radioslam/closure/overlap_skeleton.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/gauge.hpp"
#include "radioslam/graph/linearisation.hpp"
#include "radioslam/graph/loss.hpp"
#include "radioslam/graph/pose_chart.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// Below this reciprocal condition a step's information counts as singular.
constexpr double kLeastCondition = 1e-13;

/// Where a pose of the graph is in the chains.
struct ChainPlace {
  std::int32_t chain = -1;
  std::size_t at = 0;
};

/// The step that a factor makes, unless its information is singular.
template <class Pose>
std::optional<ChainStep<Pose>> step_of(const PoseGraph<Pose>& graph, const RelativePoseFactor<Pose>& factor) {
  const auto linear = linearise(graph, factor);
  const auto& [by_i, by_j, by_drift] = linear.jacobians;
  const double squared = factor.weight * linear.residual.dot(factor.information * linear.residual);
  const double weight = factor.weight * evaluate(factor.loss, squared).weight;
  const typename Pose::Jacobian information = weight * by_j.transpose() * factor.information * by_j;
  const Eigen::LLT<typename Pose::Jacobian> cholesky(information);
  if (cholesky.info() != Eigen::Success || !(cholesky.rcond() > kLeastCondition)) return std::nullopt;
  ChainStep<Pose> step{cholesky.solve(Pose::Jacobian::Identity()), {}, factor.drift};
  step.drift_effect.setZero();
  if (factor.drift.valid()) step.drift_effect = -by_j.inverse() * by_drift;
  return step;
}

template <class Pose>
class Reduction {
 public:
  Reduction(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains)
      : graph_(graph), chains_(chains), place_(graph.poses.size()), kept_(graph.poses.size(), false) {
    for (std::size_t c = 0; c < chains.size(); ++c)
      for (std::size_t k = 0; k < chains[c].poses.size(); ++k) place(c, k);
    is_step_.resize(graph.relative_poses.size(), false);
  }

  Skeleton<Pose> run() {
    for (std::size_t i = 0; i < place_.size(); ++i) kept_[i] = place_[i].chain < 0;
    take_steps();
    keep_touched();
    keep_gauge();
    for (std::size_t c = 0; c < chains_.size(); ++c) cut(c);
    renumber_poses();
    copy_factors();
    for (std::size_t c = 0; c < chains_.size(); ++c)
      for (const Stretch& stretch : skeleton_.chains[c].stretches)
        if (stretch.first < stretch.last) add_stretch(c, stretch);
    skeleton_.component = connected_components(graph_).of_pose;
    return std::move(skeleton_);
  }

 private:
  void place(std::size_t chain, std::size_t at) {
    const PoseId id = chains_[chain].poses[at];
    RADIOSLAM_CHECK(id.valid() && id.index() < place_.size() && place_[id.index()].chain < 0,
                    "a chain names poses of the graph, each once");
    place_[id.index()] = {static_cast<std::int32_t>(chain), at};
  }

  void take_steps() {
    for (const auto& chain : chains_) {
      skeleton_.chains.emplace_back();
      skeleton_.chains.back().steps.resize(std::max<std::size_t>(chain.poses.size(), 1) - 1);
    }
    for (std::size_t f = 0; f < is_step_.size(); ++f) {
      const auto& factor = graph_.relative_poses[f];
      const ChainPlace i = place_[factor.i.index()], j = place_[factor.j.index()];
      if (i.chain < 0 || i.chain != j.chain || j.at != i.at + 1) continue;
      auto& step = skeleton_.chains[static_cast<std::size_t>(i.chain)].steps[i.at];
      if (step) continue;
      step = step_of(graph_, factor);
      is_step_[f] = step.has_value();
    }
  }

  void keep(const Variable& v) {
    if (v.kind == VariableKind::kPose) kept_[static_cast<std::size_t>(v.id)] = true;
  }

  void keep_touched() {
    for (std::size_t f = 0; f < is_step_.size(); ++f)
      if (!is_step_[f])
        for (const Variable& v : variables(graph_.relative_poses[f])) keep(v);
    const auto keep_all = [&](const auto& factors) {
      for (const auto& factor : factors)
        for (const Variable& v : variables(factor)) keep(v);
    };
    keep_all(graph_.ranges);
    keep_all(graph_.bearings);
    keep_all(graph_.relative_points);
    keep_all(graph_.positions);
    keep_all(graph_.pose_priors);
  }

  void keep_gauge() {
    gauge_ = resolve_gauge(graph_);
    for (std::size_t i = 0; i < kept_.size(); ++i)
      if (gauge_.held[i]) kept_[i] = true;
    for (const auto& penalty : gauge_.penalties) kept_[penalty.pose.index()] = true;
  }

  /// Whether a stretch begins or ends at a pose: kept, at an end, or where a step is missing or the drift
  /// changes.
  bool is_cut(std::size_t c, std::size_t k) const {
    const auto& steps = skeleton_.chains[c].steps;
    if (kept_[chains_[c].poses[k].index()] || k == 0 || k == steps.size()) return true;
    return !steps[k - 1] || !steps[k] || steps[k - 1]->drift != steps[k]->drift;
  }

  void cut(std::size_t c) {
    auto& [steps, stretches] = skeleton_.chains[c];
    std::size_t first = 0;
    for (std::size_t k = 0; k < chains_[c].poses.size(); ++k) {
      if (!is_cut(c, k)) continue;
      kept_[chains_[c].poses[k].index()] = true;
      const bool ends_one = k > first;
      if (ends_one) stretches.push_back({first, k, steps[first]->drift});
      const bool begins_one = k < steps.size() && steps[k].has_value();
      if (!ends_one && !begins_one) stretches.push_back({k, k, {}});
      first = begins_one ? k : k + 1;
    }
  }

  void renumber_poses() {
    skeleton_.of_pose.resize(kept_.size());
    auto& reduced = skeleton_.graph;
    reduced.chart = graph_.chart;
    reduced.points = graph_.points;
    reduced.drifts = graph_.drifts;
    reduced.range_biases = graph_.range_biases;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      if (!kept_[i]) continue;
      skeleton_.of_pose[i] = PoseId(reduced.poses.size());
      reduced.poses.push_back(graph_.poses[i]);
      reduced.pose_fixed.push_back(gauge_.held[i]);
    }
  }

  void renumber(PoseId& id) const {
    if (id.valid()) id = skeleton_.of_pose[id.index()];
  }
  void renumber(RangeEnd<Pose>& end) const { renumber(end.pose); }

  void copy_factors() {
    auto& reduced = skeleton_.graph;
    for (std::size_t f = 0; f < is_step_.size(); ++f)
      if (!is_step_[f]) reduced.relative_poses.push_back(graph_.relative_poses[f]);
    reduced.ranges = graph_.ranges;
    reduced.bearings = graph_.bearings;
    reduced.relative_points = graph_.relative_points;
    reduced.positions = graph_.positions;
    reduced.pose_priors = graph_.pose_priors;
    reduced.drift_priors = graph_.drift_priors;
    reduced.range_bias_priors = graph_.range_bias_priors;
    const auto both = [&](auto& factors) {
      for (auto& factor : factors) renumber(factor.i), renumber(factor.j);
    };
    both(reduced.relative_poses);
    both(reduced.ranges);
    both(reduced.bearings);
    both(reduced.relative_points);
    for (auto& factor : reduced.positions) renumber(factor.i);
    for (auto& factor : reduced.pose_priors) renumber(factor.i);
  }

  const Pose& pose(std::size_t c, std::size_t k) const { return graph_.poses[chains_[c].poses[k].index()]; }

  /// A factor with residual zero whose Jacobians and information make the stretch's normal equations.
  void add_stretch(std::size_t c, const Stretch& stretch) {
    StretchSums<Pose> sums;
    const Pose T_c1_w = pose(c, stretch.first).inverse();
    for (std::size_t k = stretch.first; k < stretch.last; ++k)
      sums.add(*skeleton_.chains[c].steps[k], T_c1_w * pose(c, k + 1));
    const Pose T_c1_c2 = T_c1_w * pose(c, stretch.last);
    const typename Pose::Jacobian to_c2 = T_c1_c2.inverse().adjoint();
    const typename Pose::Jacobian chart = chart_derivative(graph_.chart, Pose());
    const typename Pose::Jacobian to_chart = chart * to_c2;
    const typename Pose::Jacobian covariance = to_chart * sums.covariance() * to_chart.transpose();
    RelativePoseFactor<Pose> factor;
    factor.i = skeleton_.of_pose[chains_[c].poses[stretch.first].index()];
    factor.j = skeleton_.of_pose[chains_[c].poses[stretch.last].index()];
    factor.T_i_j = T_c1_c2;
    factor.information = covariance.llt().solve(Pose::Jacobian::Identity());
    factor.drift = stretch.drift;
    factor.drift_jacobian = to_chart * sums.drift_effect();
    skeleton_.graph.relative_poses.push_back(factor);
  }

  const PoseGraph<Pose>& graph_;
  const std::vector<ChainOfPoses>& chains_;
  std::vector<ChainPlace> place_;
  std::vector<bool> kept_, is_step_;
  Gauge<Pose> gauge_;
  Skeleton<Pose> skeleton_;
};

}  // namespace

template <class Pose>
Skeleton<Pose> reduce_to_skeleton(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains) {
  return Reduction<Pose>(graph, chains).run();
}

template Skeleton<SE2> reduce_to_skeleton(const PoseGraph<SE2>&, const std::vector<ChainOfPoses>&);
template Skeleton<SE3> reduce_to_skeleton(const PoseGraph<SE3>&, const std::vector<ChainOfPoses>&);

}  // namespace radioslam
