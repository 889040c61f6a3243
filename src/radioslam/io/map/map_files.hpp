// Writes a team's map: its points as PLY or PCD, its occupancy grid as the PGM and YAML of ROS's map_server.
//
// Points have x y z, the normal, intensity, time (seconds of the mission's clock, of the first return) and
// robot. In a PLY, comments name the robots: `comment robot 0 a`. A PCD cannot: its robots have the same
// numbers. Coordinates are float32 unless the map reaches so far that these would be off by more than a
// millimetre. The image's first row is the highest y; 0 is occupied, 254 free, 205 unknown, which are
// map_server's own levels.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "radioslam/map/team_map.hpp"
#include "radioslam/results/map_result.hpp"

namespace radioslam {

/// Takes the next part of a file's content.
using AppendToFile = std::function<void(std::string_view part)>;

/// Binary, little endian.
void write_ply(const TeamMap& map, const AppendToFile& append);
void write_pcd(const TeamMap& map, const AppendToFile& append);

std::string format_pgm(const OccupancyGrid& grid);
/// `image`: name of the PGM, beside the YAML.
std::string format_map_yaml(const OccupancyGrid& grid, const std::string& image);

}  // namespace radioslam
