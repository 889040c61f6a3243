#include "radioslam/records/logs_of_mission.hpp"

#include <algorithm>

#include "radioslam/records/log_builder.hpp"

namespace radioslam {
namespace {

void add_measurements(const Mission& mission, RobotIndex self, LogBuilder& log) {
  const Robot& robot = mission.robots[self.index()];
  for (const RangeMeasurement& range : mission.ranges)
    if (range.i.robot == self || range.j.robot == self) log.add(range, self);
  for (const AoaMeasurement& angles : mission.aoa_measurements)
    if (angles.receiver == self) log.add(angles);
  for (const PositionFix& fix : robot.fixes) log.add(fix);
  for (const WifiScan& scan : robot.wifi) log.add(scan);
  for (const PoseMatch& match : mission.matches) log.add(match, self);
}

void add_scanned(const Mission& mission, RobotIndex self, const ScannedRecords& scanned, LogBuilder& log) {
  for (const ScannedClosure& closure : scanned.closures)
    if (closure.robot_i == self)
      log.add(closure.stamp_i, std::max(closure.stamp_i, closure.stamp_j),
              ClosureRecord{{},
                            mission.robots[closure.robot_j.index()].id,
                            closure.stamp_j,
                            closure.T_i_j,
                            closure.covariance,
                            closure.inlier_ratio,
                            closure.doubt});
  for (const ScannedPlace& place : scanned.places)
    if (place.robot == self) log.add(place.stamp, place.grid);
}

}  // namespace

MissionLogs logs_of(const Mission& mission, const KeyframeParams& params, const ScannedRecords& scanned) {
  MissionLogs logs;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    LogBuilder log(mission, robot, params);
    add_measurements(mission, RobotIndex(r), log);
    add_scanned(mission, RobotIndex(r), scanned, log);
    for (const auto& sample : robot.odometry) log.add(sample);
    log.finish();
    logs.robots.push_back({robot.id, log.take()});
    if (log.left_out() > 0)
      logs.notes.push_back("log of robot " + robot.id + ": " + std::to_string(log.left_out()) +
                           " measurements are left out: outside its odometry, or beyond what a record holds");
  }
  return logs;
}

}  // namespace radioslam
