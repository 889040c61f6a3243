// The WiFine dataset (Kozlowski et al. 2022; IS2AI/WiFine) as missions: every trajectory is one robot.
//
//   0,1,...,435,num_visible_APs,timestamp,x,y,z,floorID          -100 where an access point was not heard
//
// SOURCE is one of its files or a folder that holds them at any depth (train, val, test). A robot is named
// after its file, an access point after its column ("ap17"); frequencies are not told. Positions in metres
// are the truth, in the frame of the building, and every trajectory's time begins at 0: the robots share no
// clock. There is no odometry.
#pragma once

#include <filesystem>
#include <vector>

#include "radioslam/io/imported_mission.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// One trajectory's file and the name of its robot.
struct NamedWifineFile {
  std::string id;
  Text text;
};

/// Refuses, with their line, other columns, rows that end early, numbers that are none, times that do not run
/// forward, and a num_visible_APs that is not the number of access points heard.
ImportedMission mission_of_wifine(const std::vector<NamedWifineFile>& files, const std::string& name);

ImportedMission import_wifine(const std::filesystem::path& source);

}  // namespace radioslam
