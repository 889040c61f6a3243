#include "radioslam/doctor/odometry_coverage.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kMinMissing_s = 20, kMinMissingRatio = 0.25;
constexpr std::size_t kMinRows = 10;

/// First and last row of one recording that a robot takes part in.
struct Recording {
  std::string file;
  double first_s = 0, last_s = 0;
  std::size_t rows = 0;

  void add(Stamp stamp) {
    const double t_s = stamp.seconds();
    first_s = rows == 0 ? t_s : std::min(first_s, t_s);
    last_s = rows == 0 ? t_s : std::max(last_s, t_s);
    ++rows;
  }
};

template <class Rows>
Recording recording_of(std::string file, const Rows& rows) {
  Recording recording{std::move(file)};
  for (const auto& row : rows) recording.add(row.stamp);
  return recording;
}

std::vector<Recording> recordings_of(const Mission& mission, std::size_t r) {
  const Robot& robot = mission.robots[r];
  std::vector<Recording> recordings{recording_of(robot_file(robot.id, "wifi.csv"), robot.wifi),
                                    recording_of(robot_file(robot.id, "imu.csv"), robot.inertial),
                                    recording_of(robot_file(robot.id, "gnss.csv"), robot.fixes)};
  Recording scans{robot_file(robot.id, "lidar")}, ranges{kRangesFile}, angles{kAnglesFile};
  for (const Stamp stamp : robot.lidar.stamps) scans.add(stamp);
  const RobotIndex index(r);
  for (const auto& range : mission.ranges)
    if (range.i.robot == index || range.j.robot == index) ranges.add(range.stamp);
  for (const auto& angle : mission.aoa_measurements)
    if (angle.receiver == index || angle.transmitter.robot == index) angles.add(angle.stamp);
  recordings.insert(recordings.end(), {scans, ranges, angles});
  return recordings;
}

/// The one of which most is outside the odometry; disjoint ones are on another clock.
void check_robot(const Mission& mission, std::size_t r, std::vector<Finding>& findings) {
  const Robot& robot = mission.robots[r];
  if (robot.odometry.size() < 2) return;
  const double begin_s = robot.odometry.front().stamp.seconds(),
               end_s = robot.odometry.back().stamp.seconds();
  double most_s = kMinMissing_s;
  std::optional<Recording> longest;
  for (Recording& recording : recordings_of(mission, r)) {
    const double missing_s =
        std::max(0.0, begin_s - recording.first_s) + std::max(0.0, recording.last_s - end_s);
    if (recording.rows < kMinRows || recording.first_s > end_s || recording.last_s < begin_s ||
        missing_s < kMinMissingRatio * (recording.last_s - recording.first_s) || missing_s < most_s)
      continue;
    most_s = missing_s;
    longest = std::move(recording);
  }
  if (!longest) return;
  findings.push_back(
      {"gap", Severity::kWarning, robot.id, odometry_file(robot.id),
       "poses from " + time_text(begin_s) + " to " + time_text(end_s) + " s only, while " + longest->file +
           " has rows from " + time_text(longest->first_s) + " to " + time_text(longest->last_s) + " s",
       "odometry for the whole recording",
       "check whether it was cut: " + number(most_s) + " s of what the robot recorded cannot be placed"});
}

}  // namespace

std::vector<Finding> check_odometry_coverage(const Mission& mission) {
  std::vector<Finding> findings;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) check_robot(mission, r, findings);
  return findings;
}

}  // namespace radioslam
