// How well a trajectory by dead reckoning and one of ground truth fit, in stretches in which dead reckoning
// is nearly exact: in each the odometry is carried onto the truth by the best rigid motion.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

inline constexpr double kTruthStretch_m = 80;

/// What the truth would be if a fault of it were corrected.
struct TruthCorrection {
  double shift_s = 0;     ///< added to its times
  double factor = 1;      ///< of its positions
  bool mirrored = false;  ///< y changes sign; in space so do plane stretches without it
};

struct TruthFit {
  double squared_misfit = 0, squared_extent = 0;  ///< of the truth's places, summed, m^2
  double places = 0;

  double rmse_m() const;
  /// RMSE over the truth's extent; 0 where there is none.
  double relative() const;
};

/// `dimension` 2 or 3: in the plane without heights.
TruthFit fit_truth(const Track& odometry, const RobotTruth& truth, int dimension,
                   const TruthCorrection& correction = {});

/// T_truth_odometry in the plane, from the first 25 m; nothing where they are less than a few or do not fit.
std::optional<SE3> start_in_truth(const Track& odometry, const RobotTruth& truth);

/// Adds what stated starts and ranges contradict of the truth. `T_truth_start`: as start_in_truth gives it,
/// per robot; nothing where its truth is not to be trusted.
void check_by_truth(const Mission& mission, const Truth& truth,
                    const std::vector<std::optional<SE3>>& T_truth_start, std::vector<Finding>& findings);

}  // namespace radioslam
