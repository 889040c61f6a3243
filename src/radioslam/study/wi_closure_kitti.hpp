// Wi-Closure's test on KITTI 08, again: a recorded drive cut in two robots, radio simulated from the true
// poses (0.5 m, 10 degrees), the pairs that the overlap search keeps, and what pruning is worth once place
// recognition reports aliased matches.
//
// Wi-Closure, table I and section V-A. The thesis lets a degraded DiSCo-SLAM find the false matches; here
// they are drawn (sim/aliased_matches.hpp), so its ATE with them cannot be compared number by number.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/sim/kitti.hpp"
#include "radioslam/study/judged_run.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// The test's drive: forty true matches, and 120 that agree with each other on a wrong place.
KittiParams wi_closure_drive();

/// One of the overlap search's modes.
struct KittiMode {
  JudgedRun search;   ///< without matches: the pairs, and the seconds of the search
  JudgedRun aliased;  ///< with the aliased matches, pruned
};

/// What one seed gave.
struct WiClosureKitti {
  std::uint64_t seed = 1;
  KittiParams scenario;
  KittiMode joint, link;
  JudgedRun unpruned;                  ///< with the aliased matches, every one admitted
  JudgedRun true_matches;              ///< with the true ones alone, pruned
  std::optional<double> ate_oracle_m;  ///< without matches
};

/// Six estimates of the drive and the oracle's. Cost: some seconds for 4000 poses.
WiClosureKitti reproduce_wi_closure_kitti(const RecordedDrive& drive, const KittiParams& scenario,
                                          std::uint64_t seed, const Progress& progress = {});

/// The published rows beside ours, medians over the seeds; at least one.
StudyTable wi_closure_kitti_table(const std::vector<WiClosureKitti>& seeds);

}  // namespace radioslam
