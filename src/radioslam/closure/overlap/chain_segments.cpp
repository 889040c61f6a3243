#include "radioslam/closure/overlap/chain_segments.hpp"

#include <Eigen/LU>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/linearisation.hpp"
#include "radioslam/graph/loss.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// Reciprocal condition number below which a step's information counts as singular.
constexpr double kMinCondition = 1e-13;

/// Position of a pose of the graph in the chains.
struct ChainPlace {
  std::int32_t chain = -1;
  std::size_t at = 0;
};

/// Odometry step of a factor; nothing if its information is singular.
template <class Pose>
std::optional<ChainStep<Pose>> step_of(const PoseGraph<Pose>& graph, const RelativePoseFactor<Pose>& factor) {
  const auto linear = linearise(graph, factor);
  const auto& [by_i, by_j, by_drift] = linear.jacobians;
  const double squared = factor.weight * linear.residual.dot(factor.information * linear.residual);
  const double weight = factor.weight * evaluate(factor.loss, squared).weight;
  const typename Pose::Jacobian information = weight * by_j.transpose() * factor.information * by_j;
  const auto covariance = inverse_if_regular(information, kMinCondition);
  if (!covariance) return std::nullopt;
  ChainStep<Pose> step{*covariance, {}, factor.drift};
  step.drift_effect.setZero();
  if (factor.drift.valid()) step.drift_effect = -inverse(by_j) * by_drift;
  return step;
}

template <class Pose>
class ChainDivision {
 public:
  ChainDivision(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains)
      : graph_(graph), chains_(chains), place_(graph.poses.size()) {
    for (std::size_t c = 0; c < chains.size(); ++c)
      for (std::size_t k = 0; k < chains[c].poses.size(); ++k) place(c, k);
    out_.is_end.resize(graph.poses.size(), false);
    out_.is_step.resize(graph.relative_poses.size(), false);
  }

  ChainSegments<Pose> run() {
    for (std::size_t i = 0; i < place_.size(); ++i) out_.is_end[i] = place_[i].chain < 0;
    take_steps();
    keep_touched();
    keep_gauge();
    for (std::size_t c = 0; c < chains_.size(); ++c) cut(c);
    return std::move(out_);
  }

 private:
  void place(std::size_t chain, std::size_t at) {
    const PoseId id = chains_[chain].poses[at];
    RADIOSLAM_CHECK(id.valid() && id.index() < place_.size() && place_[id.index()].chain < 0,
                    "a chain must consist of poses of the graph, each once");
    place_[id.index()] = {static_cast<std::int32_t>(chain), at};
  }

  void take_steps() {
    for (const auto& chain : chains_) {
      out_.chains.emplace_back();
      out_.chains.back().steps.resize(std::max<std::size_t>(chain.poses.size(), 1) - 1);
    }
    for (std::size_t f = 0; f < out_.is_step.size(); ++f) {
      const auto& factor = graph_.relative_poses[f];
      const ChainPlace i = place_[factor.i.index()], j = place_[factor.j.index()];
      if (i.chain < 0 || i.chain != j.chain || j.at != i.at + 1) continue;
      auto& step = out_.chains[static_cast<std::size_t>(i.chain)].steps[i.at];
      if (step) continue;
      step = step_of(graph_, factor);
      out_.is_step[f] = step.has_value();
    }
  }

  void keep(const Variable& v) {
    if (v.kind == VariableKind::kPose) out_.is_end[static_cast<std::size_t>(v.id)] = true;
  }

  void keep_touched() {
    for (std::size_t f = 0; f < out_.is_step.size(); ++f)
      if (!out_.is_step[f])
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
    out_.gauge = resolve_gauge(graph_);
    for (std::size_t i = 0; i < out_.is_end.size(); ++i)
      if (out_.gauge.held[i]) out_.is_end[i] = true;
    for (const auto& penalty : out_.gauge.penalties) out_.is_end[penalty.pose.index()] = true;
  }

  /// Whether a segment begins or ends at a pose: kept poses, chain ends, missing steps and changes of drift.
  bool is_cut(std::size_t c, std::size_t k) const {
    const auto& steps = out_.chains[c].steps;
    if (out_.is_end[chains_[c].poses[k].index()] || k == 0 || k == steps.size()) return true;
    return !steps[k - 1] || !steps[k] || steps[k - 1]->drift != steps[k]->drift;
  }

  void cut(std::size_t c) {
    auto& [steps, segments] = out_.chains[c];
    std::size_t first = 0;
    for (std::size_t k = 0; k < chains_[c].poses.size(); ++k) {
      if (!is_cut(c, k)) continue;
      out_.is_end[chains_[c].poses[k].index()] = true;
      const bool ends_one = k > first;
      if (ends_one) segments.push_back({first, k, steps[first]->drift});
      const bool begins_one = k < steps.size() && steps[k].has_value();
      if (!ends_one && !begins_one) segments.push_back({k, k, {}});
      first = begins_one ? k : k + 1;
    }
  }

  const PoseGraph<Pose>& graph_;
  const std::vector<ChainOfPoses>& chains_;
  std::vector<ChainPlace> place_;
  ChainSegments<Pose> out_;
};

}  // namespace

template <class Pose>
ChainSegments<Pose> divide_into_segments(const PoseGraph<Pose>& graph,
                                         const std::vector<ChainOfPoses>& chains) {
  return ChainDivision<Pose>(graph, chains).run();
}

template ChainSegments<SE2> divide_into_segments(const PoseGraph<SE2>&, const std::vector<ChainOfPoses>&);
template ChainSegments<SE3> divide_into_segments(const PoseGraph<SE3>&, const std::vector<ChainOfPoses>&);

}  // namespace radioslam
