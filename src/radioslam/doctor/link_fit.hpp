// Best alignment of two dead-reckoned trajectories under the links between them, and how well it explains
// them.
//
// A range r with sigma s is normal about the distance with weight 0.8, else uniform; an angle is normal about
// one of its paths with weight 0.8, else uniform. Dead reckoning adds its own error to both sigmas. The
// alignment (x, y, z, yaw of node j's frame in node i's) that maximises the likelihood is sought from many
// starts.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/doctor/team_links.hpp"

namespace radioslam {

struct LinkFit {
  Eigen::Vector4d alignment = Eigen::Vector4d::Zero();  ///< x, y, z in metres and yaw of frame j in frame i
  double log_likelihood = 0;                            ///< of all links of the window
  std::size_t links = 0;                                ///< of the window
  double inlier_ratio = 0;                              ///< links explained, of all
  std::vector<double> residuals;  ///< of explained ranges over their own sigmas, without drift
  std::vector<double> angle_residuals;
};

struct LinkFitOptions {
  /// Given instead of sought; null to seek it.
  const Eigen::Vector4d* alignment = nullptr;
  double alignment_sigma_m = 0;
};

/// Deterministic. A link whose ends have no odometry at its time counts as unexplained.
LinkFit fit_links(const TeamLinks& team, const LinkWindow& window, const LinkFitOptions& options = {});

}  // namespace radioslam
