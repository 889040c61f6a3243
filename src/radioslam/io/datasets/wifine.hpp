// Imports the WiFine data set (Kozlowski et al. 2022; IS2AI/WiFine) as missions with one robot per
// trajectory:
//
//   0,1,...,435,num_visible_APs,timestamp,x,y,z,floorID          -100 for undetected access points
//
// SOURCE is one of its files, or a folder with files at any depth (train, val, test). A robot is named after
// its file, an access point after its column ("ap17"); frequencies are unknown. The positions (metres, in the
// frame of the building) are the ground truth. The time of every trajectory begins at 0, so the robots have
// no common clock. There is no odometry.
#pragma once

#include <filesystem>
#include <vector>

#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// One trajectory's file and the name of its robot.
struct NamedWifineFile {
  std::string id;
  Text text;
};

/// Leaves out incomplete rows, malformed numbers, second rows of a time, and rows whose num_visible_APs
/// differs from the number of received access points, with a warning, as it does refused ones of several
/// files. Refuses (InputError) other columns, and a file of which most rows are bad.
ImportedMission mission_of_wifine(const std::vector<NamedWifineFile>& files, const std::string& name);

ImportedMission import_wifine(const std::filesystem::path& source);

}  // namespace radioslam
