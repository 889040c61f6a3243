#include "radioslam/joint/closures/loop_selection.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/graph_values.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/other_valleys.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

constexpr int kMaxRounds = 15;
constexpr double kMinRedundancy = 30;  // below which a variance cannot be estimated
constexpr double kSettledScale = 0.02;
constexpr double kMinGain = 1e-3;  // of the truncated cost
constexpr double kMinScale = 0.1, kMaxScale = 10;

/// Errors that neighbouring measurements have in common leave small residuals: only residuals less than half
/// as large as stated count as smaller.
double trusted_scale(double scale) {
  return std::clamp(scale < 1 ? std::min(1.0, 2 * scale) : scale, kMinScale, kMaxScale);
}

/// Sums of squared norms and redundancies of one kind of factor.
struct VarianceComponent {
  double squares = 0, redundancy = 0;

  /// Actual over assumed standard deviation.
  double ratio() const { return redundancy < kMinRedundancy ? 1 : std::sqrt(squares / redundancy); }
};

double squared(double x) { return x * x; }

bool is_from_odometry(const FactorOrigin& origin) { return origin.source == FactorSource::kOdometry; }

template <class Pose>
bool is_comparable(const TeamLoop<Pose>& loop, const std::vector<int>& component) {
  return component[loop.segment_i] == component[loop.segment_j];
}

/// The team with all of its loops, the last relative poses of the graph. `own_shape`: as in LoopChoice.
template <class Pose>
LoopChoice<Pose> choice_of(const JointGraph<Pose>& joint, const PoseGraph<Pose>& graph,
                           const std::vector<Pose>& own_shape, const std::vector<TeamLoop<Pose>>& loops,
                           const std::vector<int>& component) {
  LoopChoice<Pose> choice{graph, {}, own_shape, segment_of_poses(joint.team), {}, {}, {}};
  for (const FactorOrigin& origin : joint.origins.relative_poses)
    choice.is_odometry.push_back(is_from_odometry(origin));
  for (const TeamLoop<Pose>& loop : loops) {
    choice.gates.push_back(loop.gate);
    choice.may_hold.push_back(is_comparable(loop, component));
    choice.accepted.push_back(loop.accepted);
  }
  return choice;
}

template <class Pose>
double gate_at(const TeamLoop<Pose>& loop, double scale) {
  return std::max(loop.gate, kPoseChiSquared999<Pose> * squared(scale));
}

template <class Pose>
class LoopSelector {
 public:
  LoopSelector(const JointGraph<Pose>& joint, const std::vector<int>& component,
               std::vector<TeamLoop<Pose>>& loops)
      : joint_(joint), component_(component), loops_(loops), graph_(joint.team.graph) {
    first_loop_ = graph_.relative_poses.size();
    for (const TeamLoop<Pose>& loop : loops) graph_.relative_poses.push_back(loop_factor(loop));
  }

  LoopSelection run(const OptimizerParams& optimizer, const Progress& progress) {
    choose_jointly(optimizer, progress);
    for (int round = 0; round < kMaxRounds; ++round) {
      report_progress(progress, "select loops", round / static_cast<double>(kMaxRounds));
      set_weights();
      optimize(graph_, optimizer);
      const auto marginals = Marginals<Pose>::compute(graph_);
      if (!marginals) break;
      const bool is_rescaled = update_scales(*marginals);
      if (!update_accepted(*marginals) && !is_rescaled) break;
    }
    set_weights();
    optimize(graph_, optimizer);
    finish();
    return result_;
  }

  const PoseGraph<Pose>& graph() const { return graph_; }

 private:
  /// The better one, in the truncated cost, of two local optima: by a graduated truncated loss on all loops
  /// at once, which may lose a minority that is right, and from those loops that the alignment stands on.
  /// From there on to better ones (other_valleys.hpp).
  void choose_jointly(const OptimizerParams& optimizer, const Progress& progress) {
    const PoseGraph<Pose> start = graph_;
    std::vector<bool> of_alignment;
    for (const TeamLoop<Pose>& loop : loops_)
      of_alignment.push_back(loop.accepted && is_comparable(loop, component_));
    choose_gradually(optimizer, progress);
    set_weights();
    LoopChoice<Pose> by_all = choice_of(joint_, graph_, start.poses, loops_, component_);
    if (by_all.accepted != of_alignment) {
      graph_ = start;
      accept(of_alignment);
      set_weights();
      optimize(graph_, optimizer);
      if (LoopChoice<Pose> by_alignment = choice_of(joint_, graph_, start.poses, loops_, component_);
          truncated_cost(by_alignment) < truncated_cost(by_all) - kMinGain)
        by_all = std::move(by_alignment);
    }
    leave_valleys(by_all, optimizer);
    accept(by_all.accepted);
    graph_ = std::move(by_all.graph);
  }

  void accept(const std::vector<bool>& accepted) {
    for (std::size_t k = 0; k < loops_.size(); ++k) loops_[k].accepted = accepted[k];
  }

  void choose_gradually(const OptimizerParams& optimizer, const Progress& progress) {
    FactorMask mask;
    mask.relative_poses.assign(graph_.relative_poses.size(), false);
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      RelativePoseFactor<Pose>& factor = graph_.relative_poses[first_loop_ + k];
      factor.weight = is_comparable(loops_[k], component_) ? 1 : 0;
      factor.loss = {LossKind::kNone, std::sqrt(loops_[k].gate)};
      mask.relative_poses[first_loop_ + k] = is_comparable(loops_[k], component_);
    }
    const auto weights = optimize_graduated(graph_, mask, GraduatedLoss::kTruncatedLeastSquares,
                                            GraduatedParams{}, optimizer, progress)
                             .weights.relative_poses;
    for (std::size_t k = 0; k < loops_.size(); ++k)
      loops_[k].accepted = mask.relative_poses[first_loop_ + k] && weights[first_loop_ + k] > 0.5;
  }

  void set_weights() {
    for (std::size_t k = 0; k < first_loop_; ++k)
      if (is_odometry(k))
        graph_.relative_poses[k].information =
            joint_.team.graph.relative_poses[k].information / squared(result_.odometry_scale);
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      RelativePoseFactor<Pose>& factor = graph_.relative_poses[first_loop_ + k];
      factor.information = inverse(loops_[k].covariance) / squared(result_.loop_scale);
      factor.weight = loops_[k].accepted ? 1 : 0;
    }
  }

  bool is_odometry(std::size_t k) const { return is_from_odometry(joint_.origins.relative_poses[k]); }

  void add(VarianceComponent& to, const RelativePoseFactor<Pose>& factor,
           const Marginals<Pose>& marginals) const {
    to.squares += squared_norm(graph_, factor);
    to.redundancy += Pose::kDof - (factor.information * marginals.relative_pose(factor.i, factor.j)).trace();
  }

  bool update_scales(const Marginals<Pose>& marginals) {
    VarianceComponent odometry, of_loops;
    for (std::size_t k = 0; k < first_loop_; ++k)
      if (is_odometry(k)) add(odometry, graph_.relative_poses[k], marginals);
    for (std::size_t k = 0; k < loops_.size(); ++k)
      if (loops_[k].accepted) add(of_loops, graph_.relative_poses[first_loop_ + k], marginals);
    const LoopSelection before = result_;
    result_.odometry_scale = trusted_scale(before.odometry_scale * odometry.ratio());
    result_.loop_scale = trusted_scale(before.loop_scale * of_loops.ratio());
    const auto changed = [](double from, double to) { return std::abs(to / from - 1) > kSettledScale; };
    return changed(before.odometry_scale, result_.odometry_scale) ||
           changed(before.loop_scale, result_.loop_scale);
  }

  bool update_accepted(const Marginals<Pose>& marginals) {
    bool changed = false;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      TeamLoop<Pose>& loop = loops_[k];
      loop.statistic = statistic(k, marginals);
      const bool holds =
          is_comparable(loop, component_) && loop.statistic <= gate_at(loop, result_.loop_scale);
      changed = changed || holds != loop.accepted;
      loop.accepted = holds;
    }
    return changed;
  }

  /// Of the loop's error against a solution without it. One in the solution has pulled it: its residual has
  /// the covariance S - P instead of S + P, and the same statistic as the error without it. In units of the
  /// stated covariance.
  double statistic(std::size_t k, const Marginals<Pose>& marginals) const {
    const RelativePoseFactor<Pose>& factor = graph_.relative_poses[first_loop_ + k];
    const double variance = squared(std::max(1.0, result_.loop_scale));
    const typename Pose::Jacobian own = loops_[k].covariance * variance,
                                  of_solution = marginals.relative_pose(factor.i, factor.j);
    const Cholesky<typename Pose::Jacobian> cholesky(
        typename Pose::Jacobian(own + (loops_[k].accepted ? -of_solution : of_solution)));
    return variance * (cholesky.succeeded() ? cholesky.whitened(residual(graph_, factor)).squaredNorm()
                                            : squared_norm(graph_, factor));
  }

  /// Statistics in the final solution, in units of the stated covariances.
  void finish() {
    for (std::size_t k = 0; k < loops_.size(); ++k)
      loops_[k].statistic =
          squared(result_.loop_scale) * squared_norm(graph_, graph_.relative_poses[first_loop_ + k]);
  }

  const JointGraph<Pose>& joint_;
  const std::vector<int>& component_;
  std::vector<TeamLoop<Pose>>& loops_;
  PoseGraph<Pose> graph_;
  std::size_t first_loop_ = 0;
  LoopSelection result_;
};

}  // namespace

template <class Pose>
LoopSelection select_loops(JointGraph<Pose>& joint, const std::vector<int>& component,
                           std::vector<TeamLoop<Pose>>& loops, const OptimizerParams& optimizer,
                           const Progress& progress) {
  LoopSelector<Pose> selector(joint, component, loops);
  const LoopSelection result = selector.run(optimizer, progress);
  GraphValues<Pose>(selector.graph()).restore(joint.team.graph);
  return result;
}

#define RADIOSLAM_LOOP_SELECTION(Pose)                                                      \
  template LoopSelection select_loops(JointGraph<Pose>&, const std::vector<int>&,           \
                                      std::vector<TeamLoop<Pose>>&, const OptimizerParams&, \
                                      const Progress&);
RADIOSLAM_LOOP_SELECTION(SE2)
RADIOSLAM_LOOP_SELECTION(SE3)
#undef RADIOSLAM_LOOP_SELECTION

}  // namespace radioslam
