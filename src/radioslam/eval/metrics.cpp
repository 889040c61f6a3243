#include "radioslam/eval/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/eval/association.hpp"
#include "radioslam/eval/mirror_image.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

using Matches = std::vector<MatchedPose>;

const EstimatedTrajectory& estimate_of(const std::string& id,
                                       const std::vector<EstimatedTrajectory>& estimate) {
  static const EstimatedTrajectory none;
  for (const auto& robot : estimate)
    if (robot.id == id) return robot;
  return none;
}

/// The pose reduced to x, y and yaw for dimension 2.
SE3 as_seen(const SE3& pose, int dimension) { return dimension == 2 ? lift(flatten(pose)) : pose; }

/// Whether the estimate is interpolated to the stamp across a stretch that has no poses.
bool is_across_untied(const EstimatedTrajectory& estimate, Stamp stamp) {
  const auto& poses = estimate.poses;
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const auto& row, Stamp at) { return row.stamp < at; });
  if (after == poses.end() || after == poses.begin() || after->stamp == stamp) return false;
  const Stamp before = std::prev(after)->stamp;
  return std::any_of(estimate.untied.begin(), estimate.untied.end(), [&](const auto& stretch) {
    return before < stretch.first && stretch.second < after->stamp;
  });
}

std::vector<Matches> match_team(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                int dimension, Association association) {
  std::vector<Matches> team;
  for (const auto& robot : truth.robots) {
    const EstimatedTrajectory& estimated = estimate_of(robot.id, estimate);
    team.push_back(match_poses(estimated.poses, robot, association));
    std::erase_if(team.back(), [&](const MatchedPose& match) {
      return is_across_untied(estimated, robot.poses[match.truth_index].stamp);
    });
    for (auto& match : team.back()) {
      match.truth = as_seen(match.truth, dimension);
      match.estimate = as_seen(match.estimate, dimension);
    }
  }
  return team;
}

std::vector<double> distance_along(const Trajectory<SE3>& truth, int dimension) {
  std::vector<double> along(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i)
    along[i] = along[i - 1] + (as_seen(truth[i].pose, dimension).translation() -
                               as_seen(truth[i - 1].pose, dimension).translation())
                                  .norm();
  return along;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::vector<double> error_values(const std::vector<PointError>& errors) {
  std::vector<double> values;
  for (const auto& error : errors) values.push_back(error.error_m);
  return values;
}

RobotMetrics classify_robot(const RobotTruth& truth, const Matches& matches, const SE3& T_truth_estimate,
                            int dimension) {
  RobotMetrics robot;
  robot.id = truth.id;
  const auto along = distance_along(truth.poses, dimension);
  std::vector<bool> covered(truth.poses.size(), false);
  for (const auto& match : matches) {
    const Eigen::Vector3d error = T_truth_estimate * match.estimate.translation() - match.truth.translation();
    robot.errors.push_back({truth.poses[match.truth_index].stamp, error.norm(), along[match.truth_index]});
    covered[match.truth_index] = true;
  }
  robot.coverage =
      share(static_cast<std::size_t>(std::count(covered.begin(), covered.end(), true)), covered.size());
  robot.ate = summarise_errors(error_values(robot.errors));
  return robot;
}

/// Relative error E = (Q_i^-1 Q_k)^-1 (P_i^-1 P_k) over consecutive compared poses, with truth Q and estimate
/// P.
std::optional<RelativeError> relative_error(const std::vector<Matches>& team, const Truth& truth) {
  double translation = 0, rotation = 0;
  RelativeError result;
  for (std::size_t r = 0; r < team.size(); ++r) {
    if (!truth.robots[r].has_orientation) continue;
    for (std::size_t k = 1; k < team[r].size(); ++k) {
      const auto& a = team[r][k - 1];
      const auto& b = team[r][k];
      const SE3 error = (a.truth.inverse() * b.truth).inverse() * (a.estimate.inverse() * b.estimate);
      translation += error.translation().squaredNorm();
      rotation += so3_log(error.rotation()).squaredNorm();
      ++result.count;
    }
  }
  if (result.count == 0) return std::nullopt;
  result.translation_rmse_m = std::sqrt(translation / static_cast<double>(result.count));
  result.rotation_rmse_rad = std::sqrt(rotation / static_cast<double>(result.count));
  return result;
}

std::optional<double> absolute_rotation_rmse_rad(const std::vector<Matches>& team, const Truth& truth,
                                                 const SE3& T_truth_estimate) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t r = 0; r < team.size(); ++r) {
    if (!truth.robots[r].has_orientation) continue;
    for (const MatchedPose& match : team[r])
      sum += so3_log((match.truth.inverse() * T_truth_estimate * match.estimate).rotation()).squaredNorm();
    count += team[r].size();
  }
  return count == 0 ? std::nullopt : std::optional(std::sqrt(sum / static_cast<double>(count)));
}

/// Value of the poses at a stamp, linear between them; the nearest pose's outside.
double value_at(const Trajectory<SE3>& poses, const std::vector<double>& values, Stamp stamp) {
  const auto later = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const auto& row, Stamp at) { return row.stamp < at; });
  const auto k = static_cast<std::size_t>(later - poses.begin());
  if (k == 0) return values.front();
  if (k == poses.size()) return values.back();
  const double gap_s = seconds_between(poses[k - 1].stamp, poses[k].stamp);
  const double ratio = seconds_between(poses[k - 1].stamp, stamp) / gap_s;
  return (1 - ratio) * values[k - 1] + ratio * values[k];
}

void add_stated_sigmas(std::vector<PointError>& errors, const EstimatedTrajectory& estimate) {
  if (errors.empty()) return;
  const auto stated = [&](const std::vector<double>& sigmas, Stamp stamp) {
    return sigmas.empty() ? std::nullopt : std::optional(value_at(estimate.poses, sigmas, stamp));
  };
  for (PointError& error : errors) {
    error.sigma_m = stated(estimate.sigma_position_m, error.stamp);
    error.sigma_team_m = stated(estimate.sigma_team_m, error.stamp);
  }
  const auto distance_s = [](const PointError& error, Stamp stamp) {
    return std::abs(seconds_between(error.stamp, stamp));
  };
  for (const auto& [stamp, pose] : estimate.poses) {
    auto nearest = std::lower_bound(errors.begin(), errors.end(), stamp,
                                    [](const PointError& error, Stamp at) { return error.stamp < at; });
    if (nearest == errors.end() ||
        (nearest != errors.begin() && distance_s(*std::prev(nearest), stamp) < distance_s(*nearest, stamp)))
      --nearest;
    nearest->at_keyframe = true;
  }
}

template <class Counts>
std::optional<Consistency> consistency(const std::vector<RobotMetrics>& robots, int dimension,
                                       std::optional<double> PointError::*sigma_m, const Counts& counts) {
  constexpr double kSigmas = 3;
  std::size_t within = 0, all = 0;
  double sum = 0;
  for (const RobotMetrics& robot : robots)
    for (const PointError& error : robot.errors) {
      if (!(error.*sigma_m) || !counts(error)) continue;
      const double sigma = *(error.*sigma_m);
      within += error.error_m <= kSigmas * sigma ? 1U : 0U;
      sum += error.error_m == 0 ? 0 : std::pow(error.error_m / sigma, 2);
      ++all;
    }
  if (all == 0) return std::nullopt;
  return Consistency{share(within, all), sum / static_cast<double>(all) / dimension};
}

}  // namespace

double quantile(const std::vector<double>& sorted, double fraction) {
  RADIOSLAM_CHECK(!sorted.empty() && fraction >= 0 && fraction <= 1,
                  "a quantile needs values and a fraction in [0, 1]");
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::optional<ErrorStatistics> summarise_errors(std::vector<double> errors_m) {
  if (errors_m.empty()) return std::nullopt;
  std::sort(errors_m.begin(), errors_m.end());
  ErrorStatistics statistics;
  statistics.count = errors_m.size();
  for (const double error : errors_m) {
    statistics.mean_m += error;
    statistics.rmse_m += error * error;
  }
  const auto count = static_cast<double>(errors_m.size());
  statistics.mean_m /= count;
  statistics.rmse_m = std::sqrt(statistics.rmse_m / count);
  statistics.median_m = quantile(errors_m, 0.5);
  statistics.p90_m = quantile(errors_m, 0.9);
  return statistics;
}

TeamMetrics evaluate_trajectories(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                  int dimension, Association association) {
  RADIOSLAM_CHECK(dimension == 2 || dimension == 3, "dimension must be 2 or 3");
  const auto team = match_team(estimate, truth, dimension, association);
  TeamMetrics metrics;
  metrics.T_truth_estimate = align_positions(positions_of(team), dimension);
  metrics.mirror_images = find_mirror_images(truth, team, dimension);
  metrics.rpe = relative_error(team, truth);
  metrics.rotation_rmse_rad = absolute_rotation_rmse_rad(team, truth, metrics.T_truth_estimate);

  std::vector<double> errors;
  double covered = 0;
  std::size_t poses = 0;
  for (std::size_t r = 0; r < team.size(); ++r) {
    auto robot = classify_robot(truth.robots[r], team[r], metrics.T_truth_estimate, dimension);
    add_stated_sigmas(robot.errors, estimate_of(robot.id, estimate));
    const auto values = error_values(robot.errors);
    errors.insert(errors.end(), values.begin(), values.end());
    covered += robot.coverage * static_cast<double>(truth.robots[r].poses.size());
    poses += truth.robots[r].poses.size();
    metrics.robots.push_back(std::move(robot));
  }
  metrics.ate = summarise_errors(std::move(errors));
  metrics.consistency =
      consistency(metrics.robots, dimension, &PointError::sigma_m, [](const auto&) { return true; });
  const bool all_known = std::all_of(estimate.begin(), estimate.end(), [&](const EstimatedTrajectory& robot) {
    const auto is_it = [&](const RobotMetrics& of) { return of.id == robot.id && !of.errors.empty(); };
    return robot.poses.empty() || std::any_of(metrics.robots.begin(), metrics.robots.end(), is_it);
  });
  if (all_known)
    metrics.team_consistency = consistency(metrics.robots, dimension, &PointError::sigma_team_m,
                                           [](const PointError& error) { return error.at_keyframe; });
  metrics.coverage = poses == 0 ? 0 : covered / static_cast<double>(poses);
  return metrics;
}

}  // namespace radioslam
