#include "radioslam/joint/closures/loop_selection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/graph_values.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/normal_equations.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/other_valleys.hpp"
#include "radioslam/joint/segment_odometry.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

constexpr int kMaxRounds = 15;
constexpr double kMinRedundancy = 12;  // below which a variance cannot be estimated
constexpr double kSettledScale = 0.02;
constexpr double kMinGain = 1e-3;  // of the truncated cost
constexpr double kMinScale = 0.1, kMaxScale = 10;
constexpr std::size_t kMinVouching = 3;  // loops that hold beside one that was set aside

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

/// The team with these loops, as accepted so far.
template <class Pose>
LoopChoice<Pose> choice_of(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops) {
  const PoseGraph<Pose>& graph = joint.team.graph;
  LoopChoice<Pose> choice{graph, {}, graph.poses, segment_of_poses(joint.team), {}, {}};
  for (const FactorOrigin& origin : joint.origins.relative_poses)
    choice.is_odometry.push_back(origin.source == FactorSource::kOdometry);
  for (const TeamLoop<Pose>& loop : loops) {
    choice.graph.relative_poses.push_back(loop_factor(loop));
    choice.gates.push_back(loop.gate);
    choice.accepted.push_back(loop.accepted);
  }
  return choice;
}

template <class Pose>
bool takes_part(const TeamLoop<Pose>& loop, const std::vector<int>& component) {
  return component[loop.segment_i] == component[loop.segment_j] && loop.admission == Admission::kAdmitted;
}

template <class Pose>
double gate_at(const TeamLoop<Pose>& loop, double scale) {
  return std::max(loop.gate, kPoseChiSquared999<Pose> * squared(scale));
}

template <class Pose>
class LoopSelector {
 public:
  LoopSelector(const JointGraph<Pose>& joint, std::vector<TeamLoop<Pose>>& loops)
      : odometry_(joint.team.graph.relative_poses),
        is_ordinary_(ordinary_steps(joint)),
        loops_(loops),
        choice_(choice_of(joint, loops)),
        equations_(choice_.graph) {}

  LoopSelection<Pose> run(const OptimizerParams& optimizer, const Progress& progress) {
    choose_jointly(optimizer, progress);
    for (int round = 0; round < kMaxRounds; ++round) {
      report_progress(progress, "select loops", round / static_cast<double>(kMaxRounds));
      solve(optimizer);
      const auto marginals = Marginals<Pose>::compute(choice_.graph);
      if (!marginals) break;
      const bool is_rescaled = update_scales(*marginals);
      if (!update_accepted(*marginals) && !is_rescaled) break;
    }
    solve(optimizer);
    finish();
    return std::move(result_);
  }

  const PoseGraph<Pose>& graph() const { return choice_.graph; }

 private:
  /// The better one, in the truncated cost, of two local optima: by a graduated truncated loss on all loops
  /// at once, which may lose a minority that is right, and from those loops that the alignment stands on.
  /// From there on to better ones (other_valleys.hpp).
  void choose_jointly(const OptimizerParams& optimizer, const Progress& progress) {
    LoopChoice<Pose> by_alignment = choice_;
    choose_gradually(choice_, {}, Fate::kHolds, GraduatedParams{}, optimizer, progress);
    if (choice_.accepted != by_alignment.accepted) {
      set_weights(by_alignment);
      optimize(by_alignment.graph, equations_, optimizer);
      if (truncated_cost(by_alignment) < truncated_cost(choice_) - kMinGain)
        choice_ = std::move(by_alignment);
    }
    result_.valleys = leave_valleys(choice_, optimizer);
    result_.cost = truncated_cost(choice_);
  }

  /// With the covariances at the present scales.
  void solve(const OptimizerParams& optimizer) {
    for (std::size_t k = 0; k < choice_.first_loop(); ++k)
      if (choice_.is_odometry[k])
        choice_.graph.relative_poses[k].information =
            odometry_[k].information / squared(scale_of_step(is_ordinary_[k], result_.odometry_scale));
    for (std::size_t k = 0; k < loops_.size(); ++k)
      choice_.loop(k).information = inverse(loops_[k].covariance) / squared(result_.loop_scale);
    set_weights(choice_);
    optimize(choice_.graph, equations_, optimizer);
  }

  void add(VarianceComponent& to, const RelativePoseFactor<Pose>& factor,
           const Marginals<Pose>& marginals) const {
    to.squares += squared_norm(choice_.graph, factor);
    to.redundancy += Pose::kDof - (factor.information * marginals.relative_pose(factor.i, factor.j)).trace();
  }

  bool update_scales(const Marginals<Pose>& marginals) {
    VarianceComponent odometry, of_loops;
    for (std::size_t k = 0; k < choice_.first_loop(); ++k)
      if (is_ordinary_[k]) add(odometry, choice_.graph.relative_poses[k], marginals);
    for (std::size_t k = 0; k < loops_.size(); ++k)
      if (choice_.accepted[k]) add(of_loops, choice_.loop(k), marginals);
    const double odometry_before = result_.odometry_scale, loops_before = result_.loop_scale;
    result_.odometry_scale = trusted_scale(odometry_before * odometry.ratio());
    result_.loop_scale = trusted_scale(loops_before * of_loops.ratio());
    const auto changed = [](double from, double to) { return std::abs(to / from - 1) > kSettledScale; };
    return changed(odometry_before, result_.odometry_scale) || changed(loops_before, result_.loop_scale);
  }

  bool update_accepted(const Marginals<Pose>& marginals) {
    std::vector<bool> holds(loops_.size());
    for (std::size_t k = 0; k < loops_.size(); ++k)
      holds[k] = statistic(k, marginals) <= gate_at(loops_[k], result_.loop_scale);
    const bool changed = holds != choice_.accepted;
    choice_.accepted = std::move(holds);
    return changed;
  }

  /// Of the loop's error against a solution without it. One in the solution has pulled it: its residual has
  /// the covariance S - P instead of S + P, and the same statistic as the error without it. In units of the
  /// stated covariance.
  double statistic(std::size_t k, const Marginals<Pose>& marginals) const {
    const RelativePoseFactor<Pose>& factor = choice_.loop(k);
    const double variance = squared(std::max(1.0, result_.loop_scale));
    const typename Pose::Jacobian own = loops_[k].covariance * variance,
                                  of_solution = marginals.relative_pose(factor.i, factor.j);
    const Cholesky<typename Pose::Jacobian> cholesky(
        typename Pose::Jacobian(own + (choice_.accepted[k] ? -of_solution : of_solution)));
    return variance * (cholesky.succeeded() ? cholesky.whitened(residual(choice_.graph, factor)).squaredNorm()
                                            : squared_norm(choice_.graph, factor));
  }

  /// What holds, and statistics in the final solution, in units of the stated covariances.
  void finish() {
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      loops_[k].accepted = choice_.accepted[k];
      loops_[k].statistic = squared(result_.loop_scale) * squared_norm(choice_.graph, choice_.loop(k));
    }
  }

  const std::vector<RelativePoseFactor<Pose>>& odometry_;  ///< as stated
  std::vector<bool> is_ordinary_;                          ///< by relative pose before the loops
  std::vector<TeamLoop<Pose>>& loops_;
  LoopChoice<Pose> choice_;
  NormalEquations<Pose> equations_;
  LoopSelection<Pose> result_;
};

/// Accepts loops that were set aside where the solution agrees with them and others that hold vouch for them.
/// Those that do not take part get their statistics.
template <class Pose>
void test_others(const PoseGraph<Pose>& solved, const std::vector<int>& component, double loop_scale,
                 std::vector<TeamLoop<Pose>>& loops) {
  const auto ends = [](const TeamLoop<Pose>& loop) { return std::minmax(loop.segment_i, loop.segment_j); };
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> held;  // between two trajectories
  for (const TeamLoop<Pose>& loop : loops)
    if (loop.accepted) ++held[ends(loop)];
  std::optional<Marginals<Pose>> marginals;
  for (TeamLoop<Pose>& loop : loops) {
    if (takes_part(loop, component)) continue;
    const RelativePoseFactor<Pose> factor = loop_factor(loop);
    loop.statistic = squared_norm(solved, factor);
    if (loop.admission != Admission::kSetAside || held[ends(loop)] < kMinVouching ||
        component[loop.segment_i] != component[loop.segment_j])
      continue;
    if (!marginals) marginals = Marginals<Pose>::compute(solved);
    if (!marginals) return;
    const typename Pose::Jacobian covariance =
        loop.covariance * squared(std::max(1.0, loop_scale)) + marginals->relative_pose(loop.i, loop.j);
    const Cholesky<typename Pose::Jacobian> cholesky(covariance);
    loop.accepted = cholesky.succeeded() &&
                    cholesky.whitened(residual(solved, factor)).squaredNorm() <= kPoseChiSquared999<Pose>;
  }
}

}  // namespace

template <class Pose>
LoopSelection<Pose> select_loops(JointGraph<Pose>& joint, const std::vector<int>& component,
                                 std::vector<TeamLoop<Pose>>& loops, const OptimizerParams& optimizer,
                                 const Progress& progress) {
  std::vector<std::size_t> members;
  std::vector<TeamLoop<Pose>> taking_part;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (takes_part(loops[k], component))
      members.push_back(k), taking_part.push_back(loops[k]);
    else
      loops[k].accepted = false;
  }
  LoopSelector<Pose> selector(joint, taking_part);
  LoopSelection<Pose> result = selector.run(optimizer, progress);
  for (std::size_t m = 0; m < members.size(); ++m) loops[members[m]] = std::move(taking_part[m]);
  for (ValleyTrial& trial : result.valleys.trials)
    for (std::size_t& loop : trial.loops) loop = members[loop];
  GraphValues<Pose>(selector.graph()).restore(joint.team.graph);
  test_others(selector.graph(), component, result.loop_scale, loops);
  return result;
}

#define RADIOSLAM_LOOP_SELECTION(Pose)                                                            \
  template LoopSelection<Pose> select_loops(JointGraph<Pose>&, const std::vector<int>&,           \
                                            std::vector<TeamLoop<Pose>>&, const OptimizerParams&, \
                                            const Progress&);
RADIOSLAM_LOOP_SELECTION(SE2)
RADIOSLAM_LOOP_SELECTION(SE3)
#undef RADIOSLAM_LOOP_SELECTION

}  // namespace radioslam
