// Reproduction of the KITTI 08 test of Wi-Closure (Wang et al., table I and section V-A): a recorded drive
// cut into two robots, radio simulated from the true poses (0.5 m, 10 degrees), the pairs that the overlap
// search keeps, and the effect of pruning on aliased matches.
//
// The thesis obtains false matches from a degraded DiSCo-SLAM; here they are drawn
// (sim/sensors/aliased_matches.hpp), so errors with them are not directly comparable.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/sim/scenarios/study_scenarios.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// "A drive cut at 34 %, 40 links of ..."
std::string drive_text(const KittiParams& drive);

/// One of the overlap search's modes.
struct KittiMode {
  EvaluatedRun search;   ///< without matches: the pairs, and the duration of the search
  EvaluatedRun aliased;  ///< with the aliased matches, pruned
};

/// The results of one seed.
struct WiClosureKitti {
  std::uint64_t seed = 1;
  KittiParams scenario;
  KittiMode joint, link;
  EvaluatedRun without_radio;          ///< with the aliased matches, which alone place the robots
  EvaluatedRun unpruned;               ///< with the aliased matches, all admitted
  EvaluatedRun least_squares;          ///< with the aliased matches, all admitted, without a robust loss
  EvaluatedRun true_matches;           ///< with the true matches only, pruned
  std::optional<double> ate_oracle_m;  ///< without matches
};

/// Eight estimates of the drive and the oracle's. Cost: some seconds for 4000 poses.
WiClosureKitti reproduce_wi_closure_kitti(const RecordedDrive& drive, const KittiParams& scenario,
                                          std::uint64_t seed, const Progress& progress = {});

/// The published rows next to the reproduced ones, medians over at least one seed.
StudyTable wi_closure_kitti_table(const std::vector<WiClosureKitti>& seeds);

}  // namespace radioslam
