// How well the links of a window agree with the dead reckoning of its two nodes: both are aligned by the
// estimate's own search and likelihood (team_frame/radio_alignment.hpp), under which links may be false or
// obstructed. The evidence is that of the alignment, the odometry's noise included, so that fits of one
// window under different corrections, units and stated noise are comparable.
#pragma once

#include <cstddef>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

struct LinkFit {
  double log_evidence = 0;  ///< of all links, per unit of the recorded measurements
  std::size_t links = 0;    ///< of the window
  double explained = 0;     ///< sum of the links' posteriors of being direct
  SE3 T_i_j;                ///< of the nodes' own frames
};

struct StatedAlignment {
  SE3 T_i_j;  ///< of the nodes' own frames
  double sigma_m = 1, sigma_rad = 1;
};

/// Deterministic.
LinkFit fit_links(const TeamLinks& team, const LinkWindow& window);

/// The same where T_i_j is stated with these standard deviations of each coordinate and of the yaw; the
/// evidence is comparable with that of `fit_links` where T_i_j may lie anywhere within 200 m.
LinkFit fit_links_near(const TeamLinks& team, const LinkWindow& window, const StatedAlignment& stated);

}  // namespace radioslam
