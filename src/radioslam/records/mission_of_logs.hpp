// The mission that the logs of a team describe.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/records/scanned_records.hpp"
#include "radioslam/records/team_log.hpp"

namespace radioslam {

struct LoggedMission {
  Mission mission;  ///< robots by name, or by the number that ends it; measurements by time, robot and record
  std::vector<ScannedClosure> closures;  ///< of scans, by time, robot and number
  std::vector<std::string> notes;        ///< what is missing, and what was left out for want of it
};

/// Depends on the records alone, not on the order in which they came. Odometry consists of the keyframes and
/// of the times of measurements in between. Where keyframes are missing, the motion is unknown but for the
/// mean speed before; the robot's first odometry is that of the first keyframe known. Measurements of robots
/// or keyframes that are not known are left out. Throws std::runtime_error with one line if the logs do not
/// make a mission: no robot with two keyframes, or robots of missions of different dimensions.
LoggedMission mission_of(const TeamLog& team);

using DecodedRecords = std::vector<std::shared_ptr<const Record>>;

/// Logs of a team as their records come, each decoded once.
class GrowingLogs {
 public:
  /// The robot's next record.
  void add(const std::string& robot, Record record);
  /// As mission_of() their log.
  LoggedMission mission() const;

 private:
  std::map<std::string, DecodedRecords> robots_;
};

/// The mission as its robots' logs describe it, in its own order of robots and with what no log says: raw
/// recordings, names, and fixes outside the odometry, whose clock may be another. A robot of which no log can
/// be made stays as recorded, without its measurements.
LoggedMission by_logs(Mission mission, const KeyframeParams& params);

}  // namespace radioslam
