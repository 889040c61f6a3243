// Surveys of the Indoor Location Competition 2.0 (Shu et al. 2021) as missions: every walk is one robot.
//
// SOURCE is one log or a folder, in which the logs are found as .../path_data_files/<id>.txt, at any depth.
// The walks of one mission share a floor plan, so logs of two folders are refused. A robot is named after its
// log; its odometry is dead reckoning (mission/dead_reckoning.hpp) with an absolute heading, its truth the
// waypoints, and its scans keep what was heard since the walk began: older entries are leftovers of the
// phone's previous walk. A scan of nothing but leftovers is left out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/imported_mission.hpp"
#include "radioslam/io/phone_log.hpp"
#include "radioslam/mission/dead_reckoning.hpp"

namespace radioslam {

/// A log and the name of its robot.
struct NamedPhoneLog {
  std::string id;
  PhoneLog log;
};

/// The mission of walks on one floor, in the order given; `name` is the mission's.
ImportedMission mission_of_walks(const std::vector<NamedPhoneLog>& walks, const std::string& name,
                                 const DeadReckoningParams& params = {});

/// Reads the logs of `source`, in the order of their names. Refuses (InputError) a source without logs, logs
/// of several folders, names that cannot be a folder's, and every malformed line.
ImportedMission import_indoor_location(const std::filesystem::path& source,
                                       const DeadReckoningParams& params = {});

}  // namespace radioslam
