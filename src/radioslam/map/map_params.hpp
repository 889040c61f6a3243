// Parameters of a team's map (team_map.hpp).
#pragma once

#include "radioslam/base/fields.hpp"

namespace radioslam {

struct MapParams {
  double voxel_m = 0.1;
  double cell_m = 0.1;
  double slice_bottom_m = 0.3;
  double slice_top_m = 1.5;
  bool pcd = false;
  double scan_step_m = 0.2;
  double scan_step_s = 0.5;
  int points_per_s = 150000;  ///< of the drive: a tenth of its time on two cores
  int max_points = 4000000;   ///< about 160 MB
  int max_cells = 8000000;
  double view_step_m = 0.5;
  double view_step_s = 1;
  double views_per_s = 2;  ///< of the drive
  double view_range_m = 30;
  double through_radius_voxels = 1.5;
  double through_depth_m = 0.15;
  int min_through = 2;
  double min_through_ratio = 0.35;
  double min_occupied_ratio = 0.25;
  int max_shown_points = 300000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(voxel_m, "m", 0.005, 100, "voxel size of the map's points, one per voxel and robot");
    RADIOSLAM_FIELD(cell_m, "m", 0.01, 100, "cell width of the occupancy grid");
    RADIOSLAM_FIELD(slice_bottom_m, "m", -100, 100,
                    "lowest height above the ground at which a return of a spatial scanner occupies a "
                    "cell of the occupancy grid");
    RADIOSLAM_FIELD(slice_top_m, "m", -100, 1000,
                    "greatest height above the ground at which a return of a spatial scanner occupies "
                    "a cell of the occupancy grid");
    RADIOSLAM_FIELD(pcd, "", 0, 1, "whether the map's points are also written as map.pcd");
    RADIOSLAM_FIELD(scan_step_m, "m", 0, 100, "distance after which another scan is mapped");
    RADIOSLAM_FIELD(scan_step_s, "s", 0, 1e6,
                    "time after which another scan is mapped, though the robot stands");
    RADIOSLAM_FIELD(
        points_per_s, "", 1000, 1e9,
        "largest number of returns that are mapped per second of the mission, over all robots; of "
        "more, an even share is");
    RADIOSLAM_FIELD(max_points, "", 1000, 2e9,
                    "largest number of points of a map; of more, the voxel size is doubled");
    RADIOSLAM_FIELD(max_cells, "", 1000, 2e9,
                    "largest number of cells of an occupancy grid; of more, the cell width is doubled");
    RADIOSLAM_FIELD(view_step_m, "m", 0, 100,
                    "distance after which another scan shows which points are seen through");
    RADIOSLAM_FIELD(view_step_s, "s", 0, 1e6,
                    "time after which another scan shows which points are seen through");
    RADIOSLAM_FIELD(
        views_per_s, "1/s", 0, 1000,
        "largest number of such scans per second of the mission, over all robots; 0 keeps all points");
    RADIOSLAM_FIELD(view_range_m, "m", 1, 1000, "range within which points can be seen through");
    RADIOSLAM_FIELD(through_radius_voxels, "", 0.5, 10,
                    "radius of the surface about a point that a ray must cross to see through it, in voxels");
    RADIOSLAM_FIELD(through_depth_m, "m", 0.01, 10,
                    "depth behind a point's surface from which a return shows that it was seen through");
    RADIOSLAM_FIELD(min_through, "", 1, 1e6, "smallest number of rays through a point that is left out");
    RADIOSLAM_FIELD(min_through_ratio, "", 0, 1,
                    "smallest share of the rays at a point that go through if it is left out; lower values "
                    "leave out more");
    RADIOSLAM_FIELD(min_occupied_ratio, "", 0, 1,
                    "smallest share of the scans through a cell that are returned by it if it is occupied");
    RADIOSLAM_FIELD(max_shown_points, "", 0, 5e6, "largest number of points of a map in the report");
  }
};

}  // namespace radioslam
