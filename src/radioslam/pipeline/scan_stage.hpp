// What robots with laser scanners make of their scans before the team is looked at: an odometry, and closures
// within each robot. Robots without scans stay as they are.
//
// The scans' poses become the robot's odometry, with the noise that was measured along with them; recorded
// odometry only tells where a scan is looked for, and leads on where the scans begin later, end earlier or
// have a gap. Inertial readings tell that better, and carry the robot where the scans tell nothing.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/lidar/scan_loops.hpp"
#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/inertial_params.hpp"
#include "radioslam/pipeline/scan_closures.hpp"

namespace radioslam {

struct ScanStageParams {
  std::string odometry = "scans";
  double gap_steps = 3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"odometry", "", 0, 0, "where both are there: of the scans, or as recorded", "scans|recorded"},
          self.odometry);
    visit(Field{"gap_steps", "", 1, 1e9,
                "times the usual time from scan to scan; recorded odometry leads across longer gaps"},
          self.gap_steps);
  }
};

struct MeasuredScans {
  std::vector<ScanClosure> closures;
  std::vector<std::string> notes;
  std::size_t scans = 0, registered = 0;
  std::size_t too_few = 0, unmatched = 0;  ///< left out: of hardly any points; not on the map
};

/// Everything that the scans need.
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

/// Gives robots with scans their odometry.
MeasuredScans measure_scans(Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress);

}  // namespace radioslam
