#include "radioslam/joint/position_fixes/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/keyframe_poses.hpp"
#include "radioslam/joint/position_fixes/heading_of_fixes.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

constexpr double kNowhere_m = std::numeric_limits<double>::infinity();

/// Path length from every fix to the nearest other inlier, or to a seed while there are no inliers.
template <class Pose>
std::vector<double> distances_to_inliers(const FixInliers<Pose>& fixes) {
  const auto& along_path = fixes.along_path;
  std::vector<double> path_m(along_path.size(), kNowhere_m);
  if (std::none_of(fixes.holds.begin(), fixes.holds.end(), [](bool holds) { return holds; })) {
    for (std::size_t k = 0; k < along_path.size(); ++k)
      for (const double seed_m : fixes.seeds_m)
        path_m[k] = std::min(path_m[k], std::abs(along_path[k].path_m - seed_m));
    return path_m;
  }
  double before_m = -kNowhere_m, after_m = kNowhere_m;
  for (std::size_t k = 0; k < along_path.size(); ++k) {
    path_m[k] = std::min(path_m[k], along_path[k].path_m - before_m);
    if (fixes.holds[k]) before_m = along_path[k].path_m;
  }
  for (std::size_t k = along_path.size(); k-- > 0;) {
    path_m[k] = std::min(path_m[k], after_m - along_path[k].path_m);
    if (fixes.holds[k]) after_m = along_path[k].path_m;
  }
  return path_m;
}

/// Classifies a robot's fixes at the graph's values and sets their loss scales. Returns whether the inliers
/// changed.
template <class Pose>
bool classify_fixes(const PoseGraph<Pose>& graph, FixInliers<Pose>& fixes, const FixGrowthParams& params) {
  const std::vector<double> path_m = distances_to_inliers(fixes);
  std::vector<bool> passes(path_m.size());
  double min_m = kNowhere_m;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    const double sigma_m = fixes.along_path[k].sigma_m, drift_m = params.max_drift_ratio * path_m[k];
    const double variance = sigma_m * sigma_m + drift_m * drift_m;
    const double residual2 = residual(graph, fixes.factors[k]).squaredNorm();
    passes[k] = residual2 <= params.gate * variance;
    if (passes[k] && !fixes.holds[k]) min_m = std::min(min_m, drift_m);
    fixes.factors[k].loss = {LossKind::kGemanMcClure,
                             std::sqrt(params.gate * variance * fixes.factors[k].information(0, 0))};
  }
  bool changed = false;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    const double near_m = std::max(fixes.along_path[k].sigma_m, params.reach * min_m);
    const bool holds = passes[k] && (fixes.holds[k] || params.max_drift_ratio * path_m[k] <= near_m);
    changed = changed || holds != fixes.holds[k];
    fixes.holds[k] = holds;
  }
  return changed;
}

}  // namespace

template <class Pose>
void grow_inliers(PoseGraph<Pose>& graph, std::vector<FixInliers<Pose>>& team, const FixGrowthParams& params,
                  const OptimizerParams& optimizer) {
  for (auto& fixes : team) fixes.holds.assign(fixes.factors.size(), false);
  for (int round = 0; round < params.max_rounds; ++round) {
    bool changed = false;
    for (auto& fixes : team) changed = classify_fixes(graph, fixes, params) || changed;
    if (!changed) return;
    for (const auto& fixes : team)
      for (std::size_t k = 0; k < fixes.factors.size(); ++k)
        if (fixes.holds[k]) graph.positions.push_back(fixes.factors[k]);
    optimize(graph, optimizer);
    graph.positions.clear();
  }
}

template void grow_inliers(PoseGraph<SE2>&, std::vector<FixInliers<SE2>>&, const FixGrowthParams&,
                           const OptimizerParams&);
template void grow_inliers(PoseGraph<SE3>&, std::vector<FixInliers<SE3>>&, const FixGrowthParams&,
                           const OptimizerParams&);

namespace {

constexpr int kMaxReclassifications = 5;

/// Number of fixes within half of `correlation_s` of each fix.
std::vector<double> fixes_near(const std::vector<PositionFix>& fixes, double correlation_s) {
  std::vector<double> counts;
  std::size_t begin = 0, end = 0;
  for (const PositionFix& fix : fixes) {
    while (seconds_between(fixes[begin].stamp, fix.stamp) > correlation_s / 2) ++begin;
    while (end < fixes.size() && seconds_between(fix.stamp, fixes[end].stamp) <= correlation_s / 2) ++end;
    counts.push_back(static_cast<double>(end - begin));
  }
  return counts;
}

/// The robot's fixes as factors on the keyframes before them; the gate, chi-squared for the fix's own
/// variance, is the scale of their loss.
template <class Pose>
RobotFixes<Pose> fixes_of(KeyframePoses<Pose>& poses, const Mission& mission, std::size_t r,
                          const FixParams& params) {
  const Robot& robot = mission.robots[r];
  const double gate = chi_squared_quantile(params.gate_probability, Pose::kDim);
  const auto near = fixes_near(robot.fixes, params.correlation_s);
  RobotFixes<Pose> result;
  for (std::size_t k = 0; k < robot.fixes.size(); ++k) {
    const PositionFix& fix = robot.fixes[k];
    const auto at = poses.at(RobotIndex(r), fix.stamp);
    if (!at) {
      ++result.outside;
      continue;
    }
    PositionFactor<Pose> factor;
    factor.i.pose = at->pose;
    factor.i.lever_arm = at->motion.T_keyframe_body.pose * robot.fix_lever_m.template head<Pose::kDim>();
    factor.position = fix.position_m.template head<Pose::kDim>();
    factor.information /= near[k] * (fix.sigma_m * fix.sigma_m + at->motion.position_m2());
    factor.loss = {LossKind::kNone, std::sqrt(gate / near[k])};
    result.factors.push_back(factor);
  }
  if (!result.factors.empty()) result.role = FixUse::kTooFew;
  return result;
}

std::vector<FixAlongPath> fixes_along_path(const Robot& robot) {
  const auto travelled = travelled_distance(robot.odometry);
  std::vector<FixAlongPath> result;
  for (const PositionFix& fix : robot.fixes)
    if (const auto pose = robot.odometry.at(fix.stamp))
      result.push_back({*pose * robot.fix_lever_m, fix.position_m, fix.sigma_m,
                        travelled_distance_at(robot.odometry, travelled, fix.stamp)});
  return result;
}

/// Removes the heading prior of a segment whose frame is no longer that of its odometry.
template <class Pose>
void drop_heading_prior(PoseGraph<Pose>& graph, PoseId first) {
  for (auto& prior : graph.pose_priors) {
    if (prior.i != first || prior.gravity_only) continue;
    prior.information.row(Pose::kDof - 1).setZero();
    prior.information.col(Pose::kDof - 1).setZero();
  }
  std::erase_if(graph.pose_priors, [](const auto& prior) { return prior.information.isZero(0); });
}

template <class Pose>
class FixPlacement {
 public:
  FixPlacement(JointGraph<Pose>& joint, const Mission& mission, const FixParams& params)
      : joint_(joint), mission_(mission), params_(params), odometry_graph_(odometry_only_graph()) {
    KeyframePoses<Pose> poses(joint, mission);
    for (std::size_t r = 0; r < mission.robots.size(); ++r)
      fixes_.push_back(fixes_of(poses, mission, r, params));
  }

  TeamFixes<Pose> run(const OptimizerParams& optimizer) {
    for (std::size_t r = 0; r < fixes_.size(); ++r) align_to_fixes(r);
    if (!aligned_.empty()) {
      fit_to_inliers(optimizer);
      for (const std::size_t r : aligned_) classify(r);
      reject_foreign_frame();
      for (const std::size_t r : aligned_) adopt(r);
    }
    return std::move(fixes_);
  }

 private:
  /// The graph without radio links, fixes and closures between robots.
  PoseGraph<Pose> odometry_only_graph() const {
    const PoseGraph<Pose>& graph = joint_.team.graph;
    PoseGraph<Pose> odometry_only;
    odometry_only.poses = graph.poses;
    odometry_only.drifts = graph.drifts;
    odometry_only.relative_poses = graph.relative_poses;
    odometry_only.pose_priors = graph.pose_priors;
    odometry_only.drift_priors = graph.drift_priors;
    return odometry_only;
  }

  bool known_start(std::size_t r) const { return joint_.team.segments[r].in_common_frame; }
  PoseId first_pose(std::size_t r) const { return PoseId(joint_.team.segments[r].first_pose); }

  void align_to_fixes(std::size_t r) {
    FixInliers<Pose> growing{fixes_[r].factors, fixes_along_path(mission_.robots[r]), {0}, {}};
    if (!known_start(r)) {
      if (growing.factors.size() < static_cast<std::size_t>(params_.min_fixes)) return;
      const auto found = align_by_fixes(growing.along_path, params_.alignment);
      if (!found) {
        fixes_[r].role = FixUse::kNoBaseline;
        return;
      }
      growing.seeds_m = {found->path_i_m, found->path_j_m};
      move_segment(odometry_graph_.poses, joint_.team.segments[r], pose_as<Pose>(found->T_fixes_start));
      drop_heading_prior(odometry_graph_, first_pose(r));
    }
    if (growing.factors.empty()) return;
    aligned_.push_back(r);
    growing_.push_back(std::move(growing));
  }

  void fit_to_inliers(const OptimizerParams& optimizer) {
    FixGrowthParams growth;
    growth.gate = chi_squared_quantile(params_.gate_probability, Pose::kDim);
    growth.max_drift_ratio = params_.alignment.max_drift_ratio;
    grow_inliers(odometry_graph_, growing_, growth, optimizer);
    for (std::size_t n = 0; n < aligned_.size(); ++n)
      for (std::size_t k = 0; k < growing_[n].holds.size(); ++k)
        fixes_[aligned_[n]].factors[k].weight = growing_[n].holds[k] ? 1 : 0;
  }

  void classify(std::size_t r) {
    double agreeing = 0;
    const auto count = static_cast<Eigen::Index>(fixes_[r].factors.size());
    Eigen::Matrix2Xd places(2, count);
    Eigen::VectorXd weights(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto& factor = fixes_[r].factors[static_cast<std::size_t>(k)];
      agreeing += factor.weight;
      places.col(k) = position(odometry_graph_, factor.i).template head<2>();
      weights[k] = factor.weight * factor.information(0, 0);
    }
    const double all = static_cast<double>(fixes_[r].factors.size());
    if (agreeing < params_.min_inlier_ratio * all || (agreeing < params_.min_fixes && !known_start(r)))
      fixes_[r].role = FixUse::kInconsistent;
    else if (known_start(r))
      fixes_[r].role = FixUse::kConstrainsRobot;
    else if (heading_information(places, weights) <
             1 / (params_.max_sigma_yaw_rad * params_.max_sigma_yaw_rad))
      fixes_[r].role = FixUse::kNoBaseline;
    else
      fixes_[r].role = FixUse::kPlacesRobot;
  }

  void reject_foreign_frame() {
    const bool other = std::any_of(aligned_.begin(), aligned_.end(), [&](std::size_t r) {
      return known_start(r) && fixes_[r].role == FixUse::kInconsistent &&
             fixes_[r].factors.size() >= static_cast<std::size_t>(params_.min_fixes);
    });
    for (auto& robot : fixes_)
      if (other && robot.role != FixUse::kNone) robot.role = FixUse::kForeignFrame;
  }

  void adopt(std::size_t r) {
    if (fixes_[r].role != FixUse::kPlacesRobot && fixes_[r].role != FixUse::kConstrainsRobot) return;
    TrajectorySegment& segment = joint_.team.segments[r];
    auto& graph = joint_.team.graph;
    std::copy_n(odometry_graph_.poses.begin() + static_cast<std::ptrdiff_t>(segment.first_pose),
                segment.pose_count, graph.poses.begin() + static_cast<std::ptrdiff_t>(segment.first_pose));
    const DriftId drift = joint_.robots[r].drift;
    if (drift.valid()) graph.drifts[drift.index()] = odometry_graph_.drifts[drift.index()];
    fixes_[r].first_factor = graph.positions.size();
    graph.positions.insert(graph.positions.end(), fixes_[r].factors.begin(), fixes_[r].factors.end());
    if (fixes_[r].role == FixUse::kConstrainsRobot) return;
    drop_heading_prior(graph, first_pose(r));
    segment.sigma_heading_rad = 0;
    segment.in_common_frame = true;
    joint_.robots[r].placed_by_fixes = true;
    fixes_[r].T_common_start = start_of(joint_.robots[r]);
  }

  /// Rigid transform that aligns the odometry's keyframes with the estimated ones.
  SE3 start_of(const RobotVariables& robot) const {
    const auto n = static_cast<Eigen::Index>(robot.poses.size());
    Eigen::Matrix2Xd odometry(2, n), estimate(2, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      odometry.col(k) = robot.odometry[at].translation().head<2>();
      estimate.col(k) = odometry_graph_.poses[robot.poses[at].index()].translation().template head<2>();
    }
    double z_m = 0;
    if constexpr (Pose::kDim == 3)
      z_m = odometry_graph_.poses[robot.poses.front().index()].translation().z() -
            robot.odometry.front().translation().z();
    return lift(align_points(odometry, estimate), z_m);
  }

  JointGraph<Pose>& joint_;
  const Mission& mission_;
  const FixParams& params_;
  PoseGraph<Pose> odometry_graph_;
  TeamFixes<Pose> fixes_;
  std::vector<std::size_t> aligned_;
  std::vector<FixInliers<Pose>> growing_;  ///< of aligned_
};

/// Returns whether any fix changed between inlier and outlier.
template <class Pose>
bool classify_again(PoseGraph<Pose>& graph, const RobotFixes<Pose>& fixes) {
  bool changed = false;
  for (std::size_t k = 0; k < fixes.factors.size(); ++k) {
    auto& factor = graph.positions[fixes.first_factor + k];
    const double weight = squared_norm(graph, factor) <= factor.loss.scale * factor.loss.scale ? 1 : 0;
    changed = changed || weight != factor.weight || factor.loss.kind != LossKind::kNone;
    factor.weight = weight;
    factor.loss.kind = LossKind::kNone;
  }
  return changed;
}

}  // namespace

bool has_fixes(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.fixes.empty(); });
}

template <class Pose>
TeamFixes<Pose> place_by_fixes(JointGraph<Pose>& joint, const Mission& mission, const FixParams& params,
                               const OptimizerParams& optimizer) {
  if (!has_fixes(mission)) return {};
  return FixPlacement<Pose>(joint, mission, params).run(optimizer);
}

template <class Pose>
KnownStarts starts_with_fixes(KnownStarts starts, const Mission& mission, const TeamFixes<Pose>& fixes) {
  for (std::size_t r = 0; r < fixes.size(); ++r)
    if (fixes[r].T_common_start)
      starts[r] = lift(flatten(*fixes[r].T_common_start * mission.robots[r].odometry.front().pose),
                       fixes[r].T_common_start->translation().z());
  return starts;
}

template <class Pose>
void constrain_by_fixes(JointGraph<Pose>& joint, TeamFixes<Pose>& fixes,
                        const TeamAlignment<Pose>& alignment) {
  auto& positions = joint.team.graph.positions;
  for (std::size_t r = 0; r < fixes.size(); ++r) {
    const auto component = static_cast<std::size_t>(alignment.component[r]);
    if (fixes[r].role != FixUse::kTooFew && fixes[r].role != FixUse::kNoBaseline) continue;
    if (!alignment.absolute[component] || !alignment.placed[r]) continue;
    fixes[r].role = FixUse::kConstrainsRobot;
    fixes[r].first_factor = positions.size();
    for (auto factor : fixes[r].factors) {
      factor.loss.kind = LossKind::kGemanMcClure;
      factor.weight = 1;
      positions.push_back(factor);
    }
  }
}

template <class Pose>
void reclassify_fixes(JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes, const OptimizerParams& optimizer,
                      const Progress& progress) {
  for (int round = 0; round < kMaxReclassifications; ++round) {
    bool changed = false;
    for (const RobotFixes<Pose>& robot : fixes)
      if (takes_part(robot.role)) changed = classify_again(joint.team.graph, robot) || changed;
    if (!changed) return;
    optimize(joint.team.graph, optimizer, progress);
  }
}

#define RADIOSLAM_FIX_STAGE(Pose)                                                                    \
  template TeamFixes<Pose> place_by_fixes(JointGraph<Pose>&, const Mission&, const FixParams&,       \
                                          const OptimizerParams&);                                   \
  template KnownStarts starts_with_fixes<Pose>(KnownStarts, const Mission&, const TeamFixes<Pose>&); \
  template void constrain_by_fixes(JointGraph<Pose>&, TeamFixes<Pose>&, const TeamAlignment<Pose>&); \
  template void reclassify_fixes(JointGraph<Pose>&, const TeamFixes<Pose>&, const OptimizerParams&,  \
                                 const Progress&);
RADIOSLAM_FIX_STAGE(SE2)
RADIOSLAM_FIX_STAGE(SE3)
#undef RADIOSLAM_FIX_STAGE

namespace {

/// Why a robot's fixes are not used; empty if they are.
std::string reason_unused(FixUse role) {
  switch (role) {
    case FixUse::kNone:
    case FixUse::kPlacesRobot:
    case FixUse::kConstrainsRobot:
      return "";
    case FixUse::kTooFew:
      return "too few to place it";
    case FixUse::kNoBaseline:
      return "too close together, or not precise enough, to give its heading";
    case FixUse::kInconsistent:
      return "too few of them agree with each other and the odometry";
    case FixUse::kForeignFrame:
      return "their frame is not that of the known starts";
  }
  return "";
}

std::string fixes_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " position fix" : " position fixes");
}

}  // namespace

template <class Pose>
void add_fix_results(RunResult& result, const JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes) {
  for (std::size_t r = 0; r < fixes.size(); ++r) {
    const std::size_t all = fixes[r].factors.size() + fixes[r].outside;
    if (all == 0) continue;
    FixResult& robot = result.robots[r].fixes.emplace();
    robot.unused = reason_unused(fixes[r].role);
    robot.place = fixes[r].role == FixUse::kPlacesRobot;
    robot.outside = fixes[r].outside;
    for (std::size_t k = 0; k < fixes[r].factors.size() && takes_part(fixes[r].role); ++k)
      ++(joint.team.graph.positions[fixes[r].first_factor + k].weight > 0 ? robot.used : robot.rejected);
    result.counts["fixes"] += static_cast<double>(all);
    result.counts["fixes_used"] += static_cast<double>(robot.used);
    result.counts["fixes_rejected"] += static_cast<double>(robot.rejected);
    if (!robot.unused.empty())
      result.notes.push_back("robot " + result.robots[r].id + ": its " + fixes_text(all) +
                             " are not used: " + robot.unused);
    else if (robot.rejected > 0)
      result.notes.push_back("robot " + result.robots[r].id + ": " + std::to_string(robot.rejected) + " of " +
                             fixes_text(robot.used + robot.rejected) +
                             " contradict the estimate and were rejected");
    if (robot.outside > 0 && robot.unused.empty())
      result.notes.push_back("robot " + result.robots[r].id + ": " + fixes_text(robot.outside) +
                             " have no odometry at their time");
  }
}

template void add_fix_results(RunResult&, const JointGraph<SE2>&, const TeamFixes<SE2>&);
template void add_fix_results(RunResult&, const JointGraph<SE3>&, const TeamFixes<SE3>&);

}  // namespace radioslam
