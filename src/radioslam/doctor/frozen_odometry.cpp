// Odometry that stops although the robot goes on: its pose repeats exactly, while other sensors change.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kMinDuration_s = 10;
constexpr double kSamePlace_m = 1e-4, kSameTurn_rad = 1e-4;
constexpr double kMinFixMotion_m = 5, kMinRangeChange_m = 2, kMinTruthMotion_m = 3;
constexpr double kTurnWindow_s = 5, kMinTurn_rad = 0.6;
constexpr std::size_t kMinRows = 6;
constexpr double kMaxSimilarityRatio = 0.6;

struct Stretch {
  double begin_s = 0, end_s = 0;
  double length_s() const { return end_s - begin_s; }
  bool contains(Stamp stamp) const { return stamp.seconds() >= begin_s && stamp.seconds() <= end_s; }
};

/// The longest in which the pose repeats.
Stretch longest_stop(const Trajectory<SE3>& odometry) {
  Stretch longest;
  std::size_t first = 0;
  for (std::size_t k = 0; k < odometry.size(); ++k) {
    const SE3 &before = odometry[first].pose, &now = odometry[k].pose;
    if ((now.translation() - before.translation()).norm() > kSamePlace_m ||
        now.rotation().angularDistance(before.rotation()) > kSameTurn_rad)
      first = k;
    const Stretch stretch{odometry[first].stamp.seconds(), odometry[k].stamp.seconds()};
    if (stretch.length_s() > longest.length_s()) longest = stretch;
  }
  return longest;
}

template <class Rows>
auto rows_within(const Rows& rows, const Stretch& stretch) {
  std::vector<typename Rows::value_type> within;
  for (const auto& row : rows)
    if (stretch.contains(row.stamp)) within.push_back(row);
  return within;
}

std::optional<std::string> motion_by_fixes(const Robot& robot, const Stretch& stop) {
  const auto fixes = rows_within(robot.fixes, stop);
  if (fixes.size() < kMinRows) return std::nullopt;
  const auto middle = [&](std::size_t begin, std::size_t end) {
    std::vector<double> x, y;
    for (std::size_t k = begin; k < end; ++k) {
      x.push_back(fixes[k].position_m.x());
      y.push_back(fixes[k].position_m.y());
    }
    return Eigen::Vector2d(median(std::move(x)), median(std::move(y)));
  };
  const std::size_t third = fixes.size() / 3;
  const double moved_m = (middle(fixes.size() - third, fixes.size()) - middle(0, third)).norm();
  if (moved_m < kMinFixMotion_m + 4 * fixes.front().sigma_m) return std::nullopt;
  return "position fixes move by " + number(moved_m) + " m";
}

/// Distances that change by more than the other end moves, in most steps: single ones may be detours.
std::optional<std::string> motion_by_ranges(const Mission& mission, const std::vector<Track>& tracks,
                                            std::size_t r, const Stretch& stop) {
  struct Last {
    double range_m, path_m;
  };
  std::map<std::size_t, Last> last;  // by robot or anchor
  std::size_t steps = 0, impossible = 0;
  for (const RangeMeasurement& range : mission.ranges) {
    const bool is_i = range.i.robot.valid() && range.i.robot.index() == r,
               is_j = range.j.robot.valid() && range.j.robot.index() == r;
    if ((!is_i && !is_j) || !stop.contains(range.stamp)) continue;
    const LinkEnd& other = is_i ? range.j : range.i;
    double path_m = 0;
    if (other.robot.valid()) {
      const auto row = tracks[other.robot.index()].at(range.stamp.seconds());
      if (!row) continue;
      path_m = row->path_m;
    }
    const std::size_t key =
        other.robot.valid() ? other.robot.index() : mission.robots.size() + other.anchor.index();
    if (const auto before = last.find(key); before != last.end()) {
      ++steps;
      impossible += std::abs(range.range_m - before->second.range_m) >
                    path_m - before->second.path_m + kMinRangeChange_m + 6 * range.sigma_m;
    }
    last[key] = {range.range_m, path_m};
  }
  if (steps < kMinRows || 2 * impossible < steps) return std::nullopt;
  return number(100 * static_cast<double>(impossible) / static_cast<double>(steps)) +
         " % of its ranges change by more than the other end moves";
}

std::optional<std::string> turn_by_gyroscope(const Robot& robot, const Stretch& stop) {
  const auto samples = rows_within(robot.inertial, stop);
  if (samples.size() < 10 * kMinRows) return std::nullopt;
  std::vector<double> rates;
  for (const ImuSample& sample : samples) rates.push_back(sample.angular_rate_radps.z());
  const double bias = median(rates);
  double turn_rad = 0, most_rad = 0;
  std::size_t first = 0;
  std::vector<double> turned(samples.size(), 0);
  for (std::size_t k = 1; k < samples.size(); ++k) {
    turn_rad += (rates[k] - bias) * seconds_between(samples[k - 1].stamp, samples[k].stamp);
    turned[k] = turn_rad;
    while (seconds_between(samples[first].stamp, samples[k].stamp) > kTurnWindow_s) ++first;
    most_rad = std::max(most_rad, std::abs(turn_rad - turned[first]));
  }
  if (most_rad < kMinTurn_rad) return std::nullopt;
  return "the gyroscope turns by " + number(most_rad) + " rad in " + number(kTurnWindow_s) + " s";
}

std::optional<std::string> motion_by_wifi(const Robot& robot, const Stretch& stop) {
  const auto scans = rows_within(robot.wifi, stop);
  if (scans.size() < 2 * kMinRows) return std::nullopt;
  std::vector<double> near, far;
  for (std::size_t k = 0; k + scans.size() / 2 < scans.size(); ++k) {
    near.push_back(fingerprint_similarity(scans[k], scans[k + 1]));
    far.push_back(fingerprint_similarity(scans[k], scans[k + scans.size() / 2]));
  }
  if (median(far) > kMaxSimilarityRatio * median(near)) return std::nullopt;
  return "its WiFi scans become " + number(median(near) / std::max(0.01, median(far))) + " times less alike";
}

Finding finding_on(const Robot& robot, const Stretch& stop, const std::string& evidence) {
  const double all_s = seconds_between(robot.odometry.front().stamp, robot.odometry.back().stamp);
  return {"frozen",
          Severity::kWarning,
          robot.id,
          odometry_file(robot.id),
          "the pose stays the same from " + time_text(stop.begin_s) + " to " + time_text(stop.end_s) +
              " s (" + number(100 * stop.length_s() / all_s) + " % of the recording), while " + evidence,
          "a pose that moves with the robot",
          "cut the recording there, or check what stopped the odometry"};
}

}  // namespace

std::vector<Finding> check_frozen_odometry(const Mission& mission) {
  std::vector<Finding> findings;
  std::vector<Track> tracks;  // once a robot stops
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    const Stretch stop = longest_stop(robot.odometry);
    if (stop.length_s() < kMinDuration_s) continue;
    if (tracks.empty())
      for (const Robot& any : mission.robots) tracks.emplace_back(any);
    auto evidence = motion_by_fixes(robot, stop);
    if (!evidence) evidence = motion_by_ranges(mission, tracks, r, stop);
    if (!evidence) evidence = turn_by_gyroscope(robot, stop);
    if (!evidence) evidence = motion_by_wifi(robot, stop);
    if (evidence) findings.push_back(finding_on(robot, stop, *evidence));
  }
  return findings;
}

std::optional<Finding> frozen_against(const Robot& robot, const RobotTruth& truth) {
  const Stretch stop = longest_stop(robot.odometry);
  if (stop.length_s() < kMinDuration_s) return std::nullopt;
  double moved_m = 0;
  std::optional<Eigen::Vector3d> first;
  for (const auto& row : truth.poses) {
    if (!stop.contains(row.stamp)) continue;
    if (!first) first = row.pose.translation();
    moved_m = std::max(moved_m, (row.pose.translation() - *first).norm());
  }
  if (moved_m < kMinTruthMotion_m) return std::nullopt;
  return finding_on(robot, stop, "the ground truth moves by " + number(moved_m) + " m");
}

}  // namespace radioslam
