#include "radioslam/rendezvous/adaptive_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/rendezvous/partner_choice.hpp"

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kRememberedObstacles = 48;
constexpr double kClearance_m = 0.5;   ///< kept from obstacles, to the side and ahead
constexpr double kTurn_rad = kPi / 9;  ///< between the headings that are tried
constexpr int kStepsOnSide = 6;        ///< for which a way round is kept to
constexpr double kBlockedPenalty = 3;  ///< in log likelihood
constexpr double kElsewhere = 0.05;    ///< likelihood floor: estimates may be wrong
constexpr int kStepsWithoutGain = 8;   ///< in ESNR, after which a detour is made
constexpr int kDetourSteps = 4;
constexpr double kGain_db = 1;
constexpr std::size_t kTrail = 6;  ///< steps that must lead somewhere

}  // namespace

void ObstacleMemory::add(const SE2& raw_pose, const ObstacleAhead& obstacle) {
  points_.push_back(raw_pose * Eigen::Vector2d(obstacle.distance_m * std::cos(obstacle.azimuth_rad),
                                               obstacle.distance_m * std::sin(obstacle.azimuth_rad)));
  if (points_.size() > kRememberedObstacles) points_.pop_front();
}

bool ObstacleMemory::blocks(const Eigen::Vector2d& from, double heading_rad, double length_m) const {
  const Eigen::Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  return std::any_of(points_.begin(), points_.end(), [&](const Eigen::Vector2d& point) {
    const Eigen::Vector2d offset = point - from;
    const double along = offset.dot(ahead);
    const double aside = std::abs(ahead.x() * offset.y() - ahead.y() * offset.x());
    return along > 0 && along < length_m + kClearance_m && aside < kClearance_m;
  });
}

double ObstacleMemory::free_heading(const Eigen::Vector2d& from, double wanted_rad, double length_m) {
  if (!blocks(from, wanted_rad, length_m)) {
    if (steps_on_side_ > 0) --steps_on_side_;
    return wanted_rad;
  }
  const int first = steps_on_side_ > 0 && side_ != 0 ? side_ : 1;
  for (int turn = 1; turn * kTurn_rad < kPi; ++turn)
    for (const int side : {first, -first}) {
      const double heading = wrap_angle(wanted_rad + side * turn * kTurn_rad);
      // Round an obstacle, the other side is no choice before this one has come to its end.
      if (steps_on_side_ > 0 && side != first && turn * kTurn_rad < kPi / 2) continue;
      if (blocks(from, heading, length_m)) continue;
      side_ = side;
      steps_on_side_ = kStepsOnSide;
      return heading;
    }
  return wrap_angle(wanted_rad + kPi);
}

void AdaptiveWalk::begin(double q_db, double alpha) {
  q_db_ = q_db;
  alpha_ = alpha;
  best_esnr_db_ = -std::numeric_limits<double>::infinity();
  steps_without_gain_ = detours_ = detour_steps_ = 0;
  trail_.clear();
}

double AdaptiveWalk::step_length(double esnr_db, const std::optional<ExpectedDirection>& expected,
                                 double max_step_m) {
  if (esnr_db >= q_db_) q_db_ = esnr_db + params_.epsilon;
  // Short steps are for the end of the walk.
  if (params_.walk != "strongest" && expected && expected->least_distance_m > 2 * max_step_m)
    return max_step_m;
  const double w = service_discrepancy(q_db_, esnr_db, alpha_) / params_.walk_sigma;
  return std::clamp(w * w, std::min(params_.min_step_m, max_step_m), max_step_m);
}

double AdaptiveWalk::choose_heading(const SE2& raw_pose, const std::vector<ArrivalPath>& arrivals,
                                    const std::optional<ExpectedDirection>& expected, double length_m,
                                    const ObstacleMemory& obstacles) const {
  double best = -std::numeric_limits<double>::infinity(), heading = 0;
  for (const ArrivalPath& arrival : arrivals) {
    const double direction = raw_pose.angle() + arrival.azimuth_rad;
    double score = std::log(10.0) / 10 * arrival.power_db;
    if (params_.walk != "strongest") {
      if (expected) {
        const double error = wrap_angle(arrival.azimuth_rad - expected->azimuth_rad);
        const double variance =
            expected->sigma_rad * expected->sigma_rad + arrival.sigma_rad * arrival.sigma_rad;
        score += std::log(kElsewhere + std::exp(-0.5 * error * error / variance));
      }
      if (obstacles.blocks(raw_pose.translation(), direction, length_m)) score -= kBlockedPenalty;
    }
    if (score > best) {
      best = score;
      heading = direction;
    }
  }
  return wrap_angle(heading);
}

/// Neither nearer by radio, nor anywhere else than some steps ago.
bool AdaptiveWalk::is_stuck(const Eigen::Vector2d& position, double esnr_db) {
  trail_.push_back(position);
  if (trail_.size() > kTrail) trail_.pop_front();
  if (esnr_db > best_esnr_db_ + kGain_db) {
    best_esnr_db_ = esnr_db;
    steps_without_gain_ = 0;
  } else {
    ++steps_without_gain_;
  }
  const bool in_place =
      trail_.size() == kTrail && (trail_.back() - trail_.front()).norm() < params_.min_step_m;
  return in_place || steps_without_gain_ >= kStepsWithoutGain;
}

std::optional<Eigen::Vector2d> AdaptiveWalk::next(const SE2& raw_pose, double esnr_db,
                                                  const std::vector<ArrivalPath>& arrivals,
                                                  const std::optional<ExpectedDirection>& expected,
                                                  double max_step_m, ObstacleMemory& obstacles) {
  if (arrivals.empty()) return std::nullopt;
  double length_m = step_length(esnr_db, expected, max_step_m);
  double wanted = choose_heading(raw_pose, arrivals, expected, length_m, obstacles);
  if (detour_steps_ > 0) {
    --detour_steps_;
    wanted = detour_heading_;
    length_m = max_step_m;
  } else if (is_stuck(raw_pose.translation(), esnr_db)) {
    // To the left and to the right in turn, each time further back.
    const double turn = kPi / 3 + kPi / 6 * (detours_ / 2 % 3);
    wanted = detour_heading_ = wrap_angle(wanted + (detours_ % 2 == 0 ? turn : -turn));
    ++detours_;
    detour_steps_ = kDetourSteps - 1;
    steps_without_gain_ = 0;
    trail_.clear();
    length_m = max_step_m;
  }
  const double heading = obstacles.free_heading(raw_pose.translation(), wanted, length_m);
  return raw_pose.translation() + length_m * Eigen::Vector2d(std::cos(heading), std::sin(heading));
}

}  // namespace radioslam
