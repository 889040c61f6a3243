#include "radioslam/rendezvous_world/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// The squared error of the latest pose per degree of freedom, by its stated covariance.
std::optional<double> nees_of(const SimulatedRobot& robot, const SE2& T_frame_common) {
  const auto& latest = robot.agent->estimate().latest();
  const Cholesky<SE2::Jacobian> factor(latest.covariance);
  if (!factor.succeeded()) return std::nullopt;
  const SE2::Tangent error = (latest.pose.inverse() * T_frame_common * robot.truth).log();
  return error.dot(factor.solve(error)) / SE2::kDof;
}

/// T_frame_common of the frame that a robot's estimate is in: the common one, or that of a robot's start.
SE2 frame_of(SimulatedTeam& team, const std::string& frame) {
  if (frame.empty()) return SE2();
  return team.robots()[team.index_of(frame)].trajectory.front().inverse();
}

std::vector<RobotMoment> moments_of(SimulatedTeam& team) {
  std::vector<RobotMoment> list;
  for (const SimulatedRobot& robot : team.robots()) {
    RobotMoment moment{robot.truth,        robot.agent->estimate().latest().pose,
                       robot.state.error,  robot.state.sigma_m,
                       robot.state.asking, !robot.seen.empty()};
    if (!robot.state.serving.empty())
      moment.serving = static_cast<std::int32_t>(team.index_of(robot.state.serving));
    list.push_back(moment);
  }
  return list;
}

}  // namespace

RunRecord::RunRecord(SimulatedTeam& team, double sensing_range_m)
    : watches_(team.robots().size()),
      sensing_range_m_(sensing_range_m),
      cells_(static_cast<std::size_t>(std::ceil(team.arena().side_m()))),
      covered_(cells_ * cells_, false) {
  run_.delta = team.robots().front().agent->delta();
}

void RunRecord::watch_threshold(std::size_t k, const SimulatedRobot& robot) {
  Watch& watch = watches_[k];
  const double error = robot.state.error;
  const bool optimized = robot.agent->optimizations() > watch.optimizations;
  watch.optimizations = robot.agent->optimizations();
  if (watch.crossed && (error <= run_.delta || optimized)) {
    run_.crossings.push_back({run_.iterations, static_cast<int>(k), *watch.crossed, error});
    watch.crossed.reset();
  } else if (error > run_.delta) {
    watch.crossed = std::max(error, watch.crossed.value_or(0));
  }
}

void RunRecord::cover(const Eigen::Vector2d& place) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(sensing_range_m_));
  const auto cells = static_cast<std::ptrdiff_t>(cells_);
  const auto x = static_cast<std::ptrdiff_t>(place.x()), y = static_cast<std::ptrdiff_t>(place.y());
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, x - reach); i <= std::min(cells - 1, x + reach); ++i)
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, y - reach); j <= std::min(cells - 1, y + reach);
         ++j) {
      const Eigen::Vector2d centre(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      if ((centre - place).norm() <= sensing_range_m_)
        covered_[static_cast<std::size_t>(i * cells + j)] = true;
    }
}

void RunRecord::add(SimulatedTeam& team, bool keep_moments) {
  ++run_.iterations;
  double sum = 0, squares = 0, sigma = 0;
  for (std::size_t k = 0; k < team.robots().size(); ++k) {
    const SimulatedRobot& robot = team.robots()[k];
    sum += robot.state.error;
    squares += robot.state.error * robot.state.error;
    sigma += robot.state.sigma_m;
    watch_threshold(k, robot);
    cover(robot.truth.translation());
    if (const auto nees = nees_of(robot, frame_of(team, robot.agent->estimate().frame()))) {
      nees_sum_ += *nees;
      ++nees_count_;
    }
    for (const std::size_t other : robot.seen)
      if (other > k && !robot.seen_before.contains(other)) ++run_.meetings;
  }
  const auto count = static_cast<double>(team.robots().size());
  run_.error.push_back(sum / count);
  run_.error_std.push_back(std::sqrt(std::max(0.0, squares / count - sum / count * sum / count)));
  run_.sigma_m.push_back(sigma / count);
  if (keep_moments) run_.moments.push_back(moments_of(team));
}

RendezvousRun RunRecord::conclude(SimulatedTeam& team) {
  std::size_t poses = 0;
  double trans = 0, rot = 0;
  for (SimulatedRobot& robot : team.robots()) {
    const FinalTrajectory estimate = robot.agent->finish();
    const SE2 T_frame_common = frame_of(team, estimate.frame);
    for (std::size_t k = 0; k < estimate.rows.size(); ++k) {
      const SE2& pose = estimate.rows[k].pose;
      const SE2 truth = T_frame_common * robot.trajectory[k];
      trans += (pose.translation() - truth.translation()).squaredNorm();
      // |R^T R' - I|_F^2 = 4 (1 - cos) in the plane.
      rot += 4 * (1 - std::cos(pose.angle() - truth.angle()));
      ++poses;
    }
    run_.metres_walked += robot.walked_m;
  }
  run_.ate_trans_mean_squared = trans / static_cast<double>(poses);
  run_.ate_rot_mean_squared = rot / static_cast<double>(poses);
  run_.nees = nees_count_ > 0 ? nees_sum_ / static_cast<double>(nees_count_) : 0;
  for (const Watch& watch : watches_)
    if (watch.crossed) ++run_.open_crossings;
  run_.covered_m2 = static_cast<double>(std::count(covered_.begin(), covered_.end(), true));
  return std::move(run_);
}

}  // namespace radioslam
