// How a robot's scans lie: by themselves, or together with its inertial readings where these can be trusted.
//
//   wild readings   single ones are left out                       (inertial/wild_readings.hpp)
//   agreement       of the rest with the first scans, laid alone   (inertial/reading_agreement.hpp)
//   scans           all of them, looked for where readings lead    (scan_track.hpp)
//   smoother        the poses that both tell together              (inertial_odometry.hpp)
//
// Readings that contradict the scans, by either look, or that show no gravity are left out with a note.
// Cost: the scans' registrations; where there are readings, those of the first `check_s` seconds twice.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/scan_params.hpp"
#include "radioslam/pipeline/scan_track.hpp"

namespace radioslam {

/// Takes wild readings out of `robot`.
ScanTrack lay_scans(Robot& robot, const ScannerTraits& traits, const ScanParams& params,
                    const KeyframeParams& keyframes, const Progress& progress,
                    std::vector<std::string>& notes);

}  // namespace radioslam
