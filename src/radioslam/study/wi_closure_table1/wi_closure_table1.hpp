// Reproduction of table I of Wi-Closure (Wang et al., section V-A) by the whole pipeline: a recorded drive
// (KITTI 08) with its recorded odometry, cut into two robots that recognise each other's places by their
// scans, without radio, with radio, and with radio that prunes the pairs of keyframes that are compared.
//
// Radio is simulated from the true poses. So are the scans, of streets that are made around the drive
// (sim/scenarios/kitti.hpp), as the recording's own are not at hand. The recorded odometry is that of the
// robots; scans serve place recognition alone. Nothing is drawn, unlike the matches of wi_closure_kitti.hpp.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/sim/scenarios/study_scenarios.hpp"
#include "radioslam/study/study_table.hpp"
#include "radioslam/study/wi_closure/place_study.hpp"

namespace radioslam {

/// The results of one seed.
struct WiClosureTable1 {
  KittiParams scenario;
  PlaceStudy places;  ///< with the defaults and the loosened set of DiSCo-SLAM, which the thesis ran
};

/// Runs on one drive, whose scans are held in memory meanwhile. Cost for KITTI 08: ten minutes to half an
/// hour, 1.4 GB of memory.
WiClosureTable1 reproduce_wi_closure_table1(const RecordedDrive& drive, const KittiParams& scenario,
                                            std::uint64_t seed, const Progress& progress = {});

/// The published rows next to the reproduced ones, medians over at least one seed.
StudyTable wi_closure_table1_table(const std::vector<WiClosureTable1>& seeds);

}  // namespace radioslam
