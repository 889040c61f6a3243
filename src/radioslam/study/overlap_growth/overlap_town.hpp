// Synthetic team for timing the overlap search at any size: two robots in the straight streets of a square
// town, with true poses and stated covariances, so that no alignment is needed first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/closure/overlap/overlap_search.hpp"

namespace radioslam {

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

}  // namespace radioslam
