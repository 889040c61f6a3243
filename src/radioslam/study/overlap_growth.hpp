// How the overlap search grows with the size of the mission: towns from small to large (overlap_town.hpp),
// both modes, on one core. Seconds are the machine's; how they grow and the ratio to testing every pair are
// not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

struct OverlapGrowthPoint {
  std::size_t poses = 0;  ///< per robot
  double pairs = 0, kept = 0, distances_evaluated = 0;
  double prepare_s = 0;  ///< until any pair's covariance can be asked for
  double search_s = 0;
  std::optional<double> all_pairs_s;  ///< testing every pair; of the smaller towns
};

struct OverlapGrowth {
  std::uint64_t seed = 1;
  std::vector<OverlapGrowthPoint> joint, link;  ///< by mode
};

/// Towns of 1000 poses a robot and up, each sqrt(10) times the last, to `most_poses`.
OverlapGrowth measure_overlap_growth(std::size_t most_poses, std::uint64_t seed,
                                     const Progress& progress = {});

/// The slope of log seconds over log (poses of both robots + pairs kept), by least squares over the points
/// of at least 10,000 poses: 1 is linear. Nothing with fewer than two of them.
std::optional<double> growth_exponent(const std::vector<OverlapGrowthPoint>& points);

StudyTable overlap_growth_table(const OverlapGrowth& growth);

}  // namespace radioslam
