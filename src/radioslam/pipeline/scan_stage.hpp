// What robots with laser scanners make of their scans before the team is looked at: an odometry, and closures
// within each robot. Robots without scans stay as they are.
//
// The scans' poses become the robot's odometry, with the noise that was measured along with them; recorded
// odometry tells where a scan is looked for and how it was swept, and leads on where the scans begin later,
// end earlier or have a gap. Inertial readings tell that better, and carry the robot where the scans tell
// nothing.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/scan_closures.hpp"
#include "radioslam/pipeline/scan_params.hpp"

namespace radioslam {

struct MeasuredScans {
  std::vector<ScanClosure> closures;
  std::vector<std::string> notes;
  std::size_t scans = 0, registered = 0;
  std::size_t too_few = 0, unmatched = 0;  ///< left out: of hardly any points; not on the map
};

/// Gives robots with scans their odometry.
MeasuredScans measure_scans(Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress);

}  // namespace radioslam
