// Everything that laser scans need.
#pragma once

#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/scan_loops.hpp"
#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/pipeline/inertial_params.hpp"

namespace radioslam {

struct ScanStageParams {
  std::string odometry = "scans";
  double gap_steps = 3;
  double row_steps =
      1.5;  ///< rows of recorded odometry less often than scans do not tell how they were swept
  double change_share = 0.2;  ///< weight of the newest change of motion in the mean

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"odometry", "", 0, 0, "where both are there: of the scans, or as recorded", "scans|recorded"},
          self.odometry);
    visit(Field{"gap_steps", "", 1, 1e9,
                "times the usual time from scan to scan; recorded odometry leads across longer gaps"},
          self.gap_steps);
    visit(
        Field{
            "row_steps", "", 0, 1e9,
            "times the usual time from scan to scan, or from row to row; recorded rows farther apart do not "
            "tell how a scan was swept, or where the next one is looked for"},
        self.row_steps);
    visit(Field{"change_share", "", 1e-3, 1,
                "weight of the newest in the mean change of motion, by which swept scans are bent"},
          self.change_share);
  }
};

struct ScanParams {
  ScanStageParams stage;
  LidarParams lidar;
  PoseSearchParams search;
  ScanLoopParams loops;
  InertialParams inertial;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("scans", self.stage);
    LidarParams::visit_sections(self.lidar, visit);
    visit("scan_search", self.search);
    visit("scan_loops", self.loops);
    InertialParams::visit_sections(self.inertial, visit);
  }
};

}  // namespace radioslam
