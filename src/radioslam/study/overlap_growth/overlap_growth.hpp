// Growth of the overlap search with the size of the mission: towns from small to large,
// both modes, on one core. Absolute times depend on the computer; growth and the ratio to testing every pair
// hardly do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

// Synthetic team for timing the overlap search at any size: two robots in the straight streets of a square
// town, with true poses and stated covariances, so that no alignment is needed first.

/// By default 1.1 million pairs, the size of KITTI 08 cut in two.
struct OverlapTown {
  std::size_t poses = 1050;  ///< per robot, a metre apart
  double side_m = 700, street_m = 50;
  double range_m = 30;
  std::size_t links = 40;
  double sigma_xy_per_sqrt_m = 0.02, sigma_yaw_per_sqrt_m_rad = 0.002;
  double link_sigma_m = 0.5, link_sigma_rad = 0.25;  ///< 10 degrees at both ends
  std::uint64_t seed = 1;
};

/// Area and links grow with the poses. Ranges are short and sensors accurate, so that there are about as many
/// kept pairs as poses.
OverlapTown growing_town(std::size_t poses);

struct OverlapTeam {
  std::vector<KeyframeOdometry<SE2>> chains;
  std::vector<OverlapLink<SE2>> links;
  std::vector<OverlapSensor> sensors;
};

OverlapTeam draw_team(const OverlapTown& town);

/// The same team as a graph with a drift per robot.
struct OverlapTeamGraph {
  PoseGraph2 graph;
  std::vector<ChainOfPoses> robots;
};

OverlapTeamGraph graph_of(const OverlapTeam& team);

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
