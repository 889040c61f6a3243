// What every robot of a recorded mission would have said on its way.
#pragma once

#include <string>
#include <vector>

#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/records/scanned_records.hpp"
#include "radioslam/records/team_log.hpp"

namespace radioslam {

struct MissionLogs {
  std::vector<RobotLog> robots;    ///< in the mission's order
  std::vector<std::string> notes;  ///< what a log cannot say and was left out
};

/// Records in order of time: facts and anchors, then keyframes and what was measured from them. A range is in
/// the log of its first robot, angles in their receiver's, matches in that of robot i. What lies outside the
/// odometry is left out, and so are raw scans, captures and inertial data: a log says what they measured
/// (`mission` has their odometry and angles already, `scanned` the rest). A closure is said when both of its
/// ends are known. Of a fingerprint with more readings than a record holds, the strongest are said.
MissionLogs logs_of(const Mission& mission, const KeyframeParams& params, const ScannedRecords& scanned = {});

}  // namespace radioslam
