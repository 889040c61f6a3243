// Occupancy image: a robot's scans from above, as cells of a grid that show walls but not floors.
//
// Scans at keyframes, evenly thinned, are placed by the estimated trajectory. For planar scanners, a cell
// counts the scans that hit it. For 3D scanners, it counts the distinct heights at which it was hit, and is
// kept if there are enough of them, absolutely and relative to the highest cells: walls, trunks and shelves
// are hit over their whole height, floors and ceilings are not, not even one above the other. The cell width
// is a multiple of the map's point spacing, doubled until there are few enough cells. Cost: one hash access
// per point.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct OccupancyImageParams {
  int max_scans = 600;
  int max_points = 20000;
  int max_cells = 40000;
  double height_step_m = 0.25;
  int min_heights = 5;  ///< above a floor and a ceiling that each cross a height step
  double min_height_ratio = 0.2;
  double cell_spacings = 0.5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(max_scans, "", 1, 1e6,
                    "largest number of scans drawn on the report's map, over all robots");
    RADIOSLAM_FIELD(max_points, "", 1, 1e8, "largest number of points used per scan");
    RADIOSLAM_FIELD(max_cells, "", 1, 1e7,
                    "largest number of cells on the report's map, over all robots; fewer cells are wider");
    RADIOSLAM_FIELD(height_step_m, "m", 0.01, 100, "height step within which hits of a cell count as one");
    RADIOSLAM_FIELD(min_heights, "", 1, 100,
                    "smallest number of distinct heights at which a cell is hit; lower values keep floors");
    RADIOSLAM_FIELD(min_height_ratio, "", 0, 1,
                    "smallest number of heights of a cell, relative to that of the highest cells");
    RADIOSLAM_FIELD(cell_spacings, "", 0.01, 100, "cell width, in map point spacings");
  }
};

/// Fills RobotResult::picture of robots with scans; needs RobotResult::dense.
void add_occupancy_images(RunResult& result, const Mission& mission, const LidarParams& lidar,
                          const OccupancyImageParams& params);

}  // namespace radioslam
