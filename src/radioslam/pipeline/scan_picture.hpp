// What a robot's scans show from above, as cells of a grid for the page's map: walls, not floors.
//
// Scans at keyframes, evenly thinned, are placed by the estimated trajectory. In a plane's scans a cell
// counts the scans that hit it. Of a scanner that measures in space it counts the heights at which it was
// hit, and is kept where these are enough, and a share of what the highest things have: walls, trunks and
// shelves are hit all the way up, floors and ceilings are not, not even one above the other. Cells are as
// wide as a share of the distance that registration leaves between points, and widened by two until few
// enough are left. Cost: a hash access per point.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct ScanPictureParams {
  int most_scans = 600;
  int most_points = 20000;
  int most_cells = 40000;
  double height_step_m = 0.25;
  int least_heights = 5;  ///< a floor and a ceiling, each on the border of two
  double least_share = 0.2;
  double cell_spacings = 0.5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"most_scans", "", 1, 1e6, "scans on the page's map, over all robots"}, self.most_scans);
    visit(Field{"most_points", "", 1, 1e8, "points of each"}, self.most_points);
    visit(Field{"most_cells", "", 1, 1e7, "cells on the page's map, over all robots"}, self.most_cells);
    visit(Field{"height_step_m", "m", 0.01, 100, "heights so far apart count as two"}, self.height_step_m);
    visit(Field{"least_heights", "", 1, 100, "at so many heights a cell is hit, or is a floor"},
          self.least_heights);
    visit(Field{"least_share", "", 0, 1, "and at such a share of the heights of the highest cells"},
          self.least_share);
    visit(Field{"cell_spacings", "", 0.01, 100, "width of a cell, in spacings of the map's points"},
          self.cell_spacings);
  }
};

/// Fills RobotResult::picture of the robots with scans; RobotResult::dense is there.
void add_scan_pictures(RunResult& result, const Mission& mission, const LidarParams& lidar,
                       const ScanPictureParams& params);

}  // namespace radioslam
