// Imports surveys of the Indoor Location Competition 2.0 (Shu et al. 2021) as missions with one robot per
// walk.
//
// SOURCE is a log, or a folder with logs .../path_data_files/<id>.txt at any depth. All walks of a mission
// must be on the same floor plan, so logs in several folders are refused. A robot is named after its log; its
// odometry is dead reckoning (mission/dead_reckoning.hpp) with an absolute heading, its ground truth are the
// waypoints. WiFi entries received before the walk began are left over from the phone's previous walk and are
// left out, as are scans that contain nothing else.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/wifi/phone_log.hpp"
#include "radioslam/mission/dead_reckoning.hpp"

namespace radioslam {

/// A log and the name of its robot.
struct NamedPhoneLog {
  std::string id;
  PhoneLog log;
};

/// Gives a robot its carrier's walk: odometry, its noise, and its heading.
void set_walk(Robot& robot, const DeadReckoning& reckoned);

/// The positions that the surveyor marked, as poses without orientation.
Trajectory<SE3> waypoints_of(const PhoneLog& log);

/// Builds the mission `name` of walks on one floor, in the given order.
ImportedMission mission_of_walks(const std::vector<NamedPhoneLog>& walks, const std::string& name,
                                 const DeadReckoningParams& params = {});

/// Reads the logs of `source`, sorted by name; a log that is refused, or whose name is not a valid robot
/// name, is left out with a warning. Refuses (InputError) a source without logs, logs in several folders, and
/// a source of which most logs are refused.
ImportedMission import_indoor_location(const std::filesystem::path& source,
                                       const DeadReckoningParams& params = {});

}  // namespace radioslam
