// Growth of the overlap search with the size of the mission: towns from small to large (overlap_town.hpp),
// both modes, on one core. Absolute times depend on the computer; growth and the ratio to testing every pair
// hardly do.
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
  double prepare_s = 0;  ///< until covariances of pairs are available
  double search_s = 0;
  std::optional<double> all_pairs_s;  ///< testing every pair; only for smaller towns
};

struct OverlapGrowth {
  std::uint64_t seed = 1;
  std::vector<OverlapGrowthPoint> joint, link;  ///< by mode
};

/// Towns of 1000 poses per robot and up, each sqrt(10) times the previous one, to `max_poses`.
OverlapGrowth measure_overlap_growth(std::size_t max_poses, std::uint64_t seed,
                                     const Progress& progress = {});

/// Least-squares slope of log seconds over log (poses of both robots + pairs kept), over the points of at
/// least 10,000 poses: 1 is linear. Nothing with fewer than two of them.
std::optional<double> growth_exponent(const std::vector<OverlapGrowthPoint>& points);

StudyTable overlap_growth_table(const OverlapGrowth& growth);

}  // namespace radioslam
