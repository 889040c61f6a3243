#include "radioslam/pipeline/fix_stage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/pipeline/fix_growth.hpp"
#include "radioslam/team_frame/level_priors.hpp"

namespace radioslam {
namespace {

constexpr int kSettlingRounds = 5;

/// How many of the fixes lie within half of `correlation_s` of each.
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

/// The gate, chi-squared over the fix's own variance, becomes the loss's scale.
template <class Pose>
RobotFixes<Pose> fixes_of(const JointGraph<Pose>& joint, const Mission& mission, std::size_t r,
                          const FixParams& params) {
  const Robot& robot = mission.robots[r];
  const double gate = chi_squared_quantile(params.gate_probability, Pose::kDim);
  const auto near = fixes_near(robot.fixes, params.correlation_s);
  RobotFixes<Pose> result;
  for (std::size_t k = 0; k < robot.fixes.size(); ++k) {
    const PositionFix& fix = robot.fixes[k];
    PositionFactor<Pose> factor;
    factor.i.pose = pose_at(joint, RobotIndex(r), fix.stamp);
    if (!factor.i.pose.valid()) {
      ++result.outside;
      continue;
    }
    factor.i.lever_arm = robot.fix_lever_m.template head<Pose::kDim>();
    factor.position = fix.position_m.template head<Pose::kDim>();
    factor.information /= near[k] * fix.sigma_m * fix.sigma_m;
    factor.loss = {LossKind::kNone, std::sqrt(gate / near[k])};
    result.factors.push_back(factor);
  }
  if (!result.factors.empty()) result.role = FixRole::kTooFew;
  return result;
}

std::vector<FixOfWay> fixes_of_way(const Robot& robot) {
  const auto walked = distance_walked(robot.odometry);
  std::vector<FixOfWay> result;
  for (const PositionFix& fix : robot.fixes)
    if (const auto pose = robot.odometry.at(fix.stamp))
      result.push_back({*pose * robot.fix_lever_m, fix.position_m, fix.sigma_m,
                        distance_walked_at(robot.odometry, walked, fix.stamp)});
  return result;
}

/// The piece's heading in the common frame is no longer that of its odometry.
template <class Pose>
void forget_heading(PoseGraph<Pose>& graph, PoseId first) {
  for (auto& prior : graph.pose_priors) {
    if (prior.i != first) continue;
    prior.information.row(Pose::kDof - 1).setZero();
    prior.information.col(Pose::kDof - 1).setZero();
  }
  std::erase_if(graph.pose_priors, [](const auto& prior) { return prior.information.isZero(0); });
}

template <class Pose>
class FixPlacement {
 public:
  FixPlacement(JointGraph<Pose>& joint, const Mission& mission, const FixParams& params)
      : joint_(joint), mission_(mission), params_(params), ways_(ways_alone()) {
    for (std::size_t r = 0; r < mission.robots.size(); ++r)
      fixes_.push_back(fixes_of(joint, mission, r, params));
  }

  TeamFixes<Pose> run(const OptimizerParams& optimizer) {
    for (std::size_t r = 0; r < fixes_.size(); ++r) lay_onto_fixes(r);
    if (!laid_.empty()) {
      turn_level_priors(ways_);
      bend(optimizer);
      for (const std::size_t r : laid_) judge(r);
      drop_other_frame();
      for (const std::size_t r : laid_) adopt(r);
      turn_level_priors(joint_.team.graph);
    }
    return std::move(fixes_);
  }

 private:
  /// Every robot's own factors.
  PoseGraph<Pose> ways_alone() const {
    const PoseGraph<Pose>& graph = joint_.team.graph;
    PoseGraph<Pose> ways;
    ways.poses = graph.poses;
    ways.drifts = graph.drifts;
    ways.relative_poses = graph.relative_poses;
    ways.pose_priors = graph.pose_priors;
    ways.drift_priors = graph.drift_priors;
    return ways;
  }

  bool known_start(std::size_t r) const { return joint_.team.pieces[r].in_common_frame; }
  PoseId first_pose(std::size_t r) const { return PoseId(joint_.team.pieces[r].first_pose); }

  void lay_onto_fixes(std::size_t r) {
    GrowingFixes<Pose> growing{fixes_[r].factors, fixes_of_way(mission_.robots[r]), {0}, {}};
    if (!known_start(r)) {
      if (growing.factors.size() < static_cast<std::size_t>(params_.least_fixes)) return;
      const auto found = align_by_fixes(growing.of_way, params_.alignment);
      if (!found) {
        fixes_[r].role = FixRole::kTooClose;
        return;
      }
      growing.seeds_m = {found->way_i_m, found->way_j_m};
      move_piece(ways_.poses, joint_.team.pieces[r], pose_as<Pose>(found->T_fixes_start));
      forget_heading(ways_, first_pose(r));
    }
    if (growing.factors.empty()) return;
    laid_.push_back(r);
    growing_.push_back(std::move(growing));
  }

  void bend(const OptimizerParams& optimizer) {
    FixGrowthParams growth;
    growth.gate = chi_squared_quantile(params_.gate_probability, Pose::kDim);
    growth.drift_share = params_.alignment.drift_share;
    grow_fixes(ways_, growing_, growth, optimizer);
    for (std::size_t n = 0; n < laid_.size(); ++n)
      for (std::size_t k = 0; k < growing_[n].holds.size(); ++k)
        fixes_[laid_[n]].factors[k].weight = growing_[n].holds[k] ? 1 : 0;
  }

  void judge(std::size_t r) {
    double agreeing = 0, information = 0;
    typename Pose::Point middle = Pose::Point::Zero();
    for (const auto& factor : fixes_[r].factors) {
      agreeing += factor.weight;
      information += factor.weight * factor.information(0, 0);
      middle += factor.weight * factor.information(0, 0) * position(ways_, factor.i);
    }
    middle /= information;
    double of_yaw = 0;
    for (const auto& factor : fixes_[r].factors)
      of_yaw += factor.weight * factor.information(0, 0) *
                (position(ways_, factor.i) - middle).template head<2>().squaredNorm();
    const double all = static_cast<double>(fixes_[r].factors.size());
    if (agreeing < params_.least_share * all || (agreeing < params_.least_fixes && !known_start(r)))
      fixes_[r].role = FixRole::kDisagree;
    else if (known_start(r))
      fixes_[r].role = FixRole::kHold;
    else if (of_yaw < 1 / (params_.most_sigma_yaw_rad * params_.most_sigma_yaw_rad))
      fixes_[r].role = FixRole::kTooClose;
    else
      fixes_[r].role = FixRole::kPlace;
  }

  void drop_other_frame() {
    const bool other = std::any_of(laid_.begin(), laid_.end(), [&](std::size_t r) {
      return known_start(r) && fixes_[r].role == FixRole::kDisagree &&
             fixes_[r].factors.size() >= static_cast<std::size_t>(params_.least_fixes);
    });
    for (auto& robot : fixes_)
      if (other && robot.role != FixRole::kNone) robot.role = FixRole::kOtherFrame;
  }

  void adopt(std::size_t r) {
    if (fixes_[r].role != FixRole::kPlace && fixes_[r].role != FixRole::kHold) return;
    Piece& piece = joint_.team.pieces[r];
    auto& graph = joint_.team.graph;
    std::copy_n(ways_.poses.begin() + static_cast<std::ptrdiff_t>(piece.first_pose), piece.pose_count,
                graph.poses.begin() + static_cast<std::ptrdiff_t>(piece.first_pose));
    const DriftId drift = joint_.robots[r].drift;
    if (drift.valid()) graph.drifts[drift.index()] = ways_.drifts[drift.index()];
    fixes_[r].first_factor = graph.positions.size();
    graph.positions.insert(graph.positions.end(), fixes_[r].factors.begin(), fixes_[r].factors.end());
    if (fixes_[r].role == FixRole::kHold) return;
    forget_heading(graph, first_pose(r));
    piece.sigma_heading_rad = 0;
    piece.in_common_frame = true;
    joint_.robots[r].placed_by_fixes = true;
    fixes_[r].T_common_start = start_of(joint_.robots[r]);
  }

  /// The rigid motion that carries the odometry's keyframes onto the estimated ones.
  SE3 start_of(const JointRobot& robot) const {
    const auto n = static_cast<Eigen::Index>(robot.poses.size());
    Eigen::Matrix2Xd odometry(2, n), estimate(2, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      odometry.col(k) = robot.odometry[at].translation().head<2>();
      estimate.col(k) = ways_.poses[robot.poses[at].index()].translation().template head<2>();
    }
    double z_m = 0;
    if constexpr (Pose::kDim == 3)
      z_m = ways_.poses[robot.poses.front().index()].translation().z() -
            robot.odometry.front().translation().z();
    return lift(align_points(odometry, estimate), z_m);
  }

  JointGraph<Pose>& joint_;
  const Mission& mission_;
  const FixParams& params_;
  PoseGraph<Pose> ways_;
  TeamFixes<Pose> fixes_;
  std::vector<std::size_t> laid_;
  std::vector<GrowingFixes<Pose>> growing_;  ///< of these
};

/// Whether any verdict changed.
template <class Pose>
bool judge_anew(PoseGraph<Pose>& graph, const RobotFixes<Pose>& fixes) {
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

void add_fix_moments(const Mission& mission, std::vector<std::vector<Stamp>>& moments) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    for (const PositionFix& fix : mission.robots[r].fixes) moments[r].push_back(fix.stamp);
}

template <class Pose>
TeamFixes<Pose> place_by_fixes(JointGraph<Pose>& joint, const Mission& mission, const FixParams& params,
                               const OptimizerParams& optimizer) {
  if (!has_fixes(mission)) return {};
  return FixPlacement<Pose>(joint, mission, params).run(optimizer);
}

template <class Pose>
std::optional<Mission> with_placed_starts(const Mission& mission, const TeamFixes<Pose>& fixes) {
  std::optional<Mission> result;
  for (std::size_t r = 0; r < fixes.size(); ++r) {
    if (!fixes[r].T_common_start) continue;
    if (!result) result = mission;
    Robot& robot = result->robots[r];
    robot.initial_pose = lift(flatten(*fixes[r].T_common_start * robot.odometry.front().pose),
                              fixes[r].T_common_start->translation().z());
  }
  return result;
}

template <class Pose>
void hold_by_fixes(JointGraph<Pose>& joint, TeamFixes<Pose>& fixes, const TeamPlacement<Pose>& placement) {
  auto& positions = joint.team.graph.positions;
  for (std::size_t r = 0; r < fixes.size(); ++r) {
    const auto component = static_cast<std::size_t>(placement.component[r]);
    if (fixes[r].role != FixRole::kTooFew && fixes[r].role != FixRole::kTooClose) continue;
    if (!placement.absolute[component] || !placement.placed[r]) continue;
    fixes[r].role = FixRole::kHold;
    fixes[r].first_factor = positions.size();
    for (auto factor : fixes[r].factors) {
      factor.loss.kind = LossKind::kGemanMcClure;
      factor.weight = 1;
      positions.push_back(factor);
    }
  }
}

template <class Pose>
void settle_fixes(JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes, const OptimizerParams& optimizer,
                  const Progress& progress) {
  for (int round = 0; round < kSettlingRounds; ++round) {
    bool changed = false;
    for (const RobotFixes<Pose>& robot : fixes)
      if (takes_part(robot.role)) changed = judge_anew(joint.team.graph, robot) || changed;
    if (!changed) return;
    optimize(joint.team.graph, optimizer, progress);
  }
}

#define RADIOSLAM_FIX_STAGE(Pose)                                                                   \
  template TeamFixes<Pose> place_by_fixes(JointGraph<Pose>&, const Mission&, const FixParams&,      \
                                          const OptimizerParams&);                                  \
  template std::optional<Mission> with_placed_starts<Pose>(const Mission&, const TeamFixes<Pose>&); \
  template void hold_by_fixes(JointGraph<Pose>&, TeamFixes<Pose>&, const TeamPlacement<Pose>&);     \
  template void settle_fixes(JointGraph<Pose>&, const TeamFixes<Pose>&, const OptimizerParams&,     \
                             const Progress&);
RADIOSLAM_FIX_STAGE(SE2)
RADIOSLAM_FIX_STAGE(SE3)
#undef RADIOSLAM_FIX_STAGE

}  // namespace radioslam
