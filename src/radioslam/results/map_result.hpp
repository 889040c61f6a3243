// What a run shows of the map of a team: an occupancy grid, and a share of the points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Occupancy grid in the plane of the frame's x and y.
struct OccupancyGrid {
  double cell_m = 0;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< lower left corner of the first cell
  std::size_t width = 0, height = 0;                   ///< cells along x and y
  std::vector<CellState> cells;                        ///< row by row from the smallest y, each by x

  bool empty() const { return cells.empty(); }
};

/// Point of a map: the mean of one robot's returns in a voxel.
struct MapPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< in the frame of the component
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< of unit length, towards the scanner; zero: unknown
  float intensity = 0;      ///< mean, in the scanner's own units; 0 if not recorded
  float time_s = 0;         ///< of the first return, since the map's start
  std::uint16_t robot = 0;  ///< index of MapResult::robots
};

/// Map of the robots of one component, in its frame.
struct MapResult {
  std::vector<std::string> robots;  ///< those with scans
  Stamp start;                      ///< of the first scan that is used
  double voxel_m = 0;
  bool has_intensity = false;
  OccupancyGrid grid;
  std::vector<MapPoint> points;  ///< evenly chosen; all are in map.ply
  std::size_t all_points = 0;
  std::size_t scans = 0;         ///< that were used
  std::size_t seen_through = 0;  ///< points left out, since other scans look through them
};

}  // namespace radioslam
