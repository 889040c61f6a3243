// How good an estimate is against the truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// One trajectory to be judged; `poses` in a frame shared by the whole team.
struct EstimatedTrajectory {
  std::string id;
  Trajectory<SE3> poses;
};

/// How an estimate is matched with the truth.
enum class Association {
  kInterpolate,  ///< the estimate is interpolated at the truth's stamps
  kNearest,      ///< evo's: nearest stamps within 0.01 s
};

/// Position errors in metres. Empty statistics (no truth covered) are absent, not zero.
struct ErrorStatistics {
  double rmse_m = 0;
  double mean_m = 0;
  double median_m = 0;
  double p90_m = 0;
  std::size_t count = 0;
};

/// One compared position.
struct PointError {
  Stamp stamp;
  double error_m = 0;
  double along_m = 0;  ///< distance walked along the truth
};

/// Relative pose error over consecutive compared poses (evo's default, one frame apart), pooled over the
/// robots whose truth has an orientation.
struct RelativeError {
  double translation_rmse_m = 0;
  double rotation_rmse_rad = 0;
  std::size_t count = 0;
};

/// One robot's share.
struct RobotMetrics {
  std::string id;
  std::optional<ErrorStatistics> ate;
  double coverage = 0;
  std::vector<PointError> errors;
};

/// The team's absolute trajectory error after ONE rigid alignment of the whole team.
struct TeamMetrics {
  std::optional<ErrorStatistics> ate;
  std::optional<RelativeError> rpe;  ///< absent where no truth has an orientation
  double coverage = 0;               ///< share of the truth's poses that the estimate covers
  SE3 T_truth_estimate;
  std::vector<RobotMetrics> robots;
};

/// Compares `estimate` with `truth` (matched by id) after one alignment; `dimension` 2 aligns in the plane
/// and measures in the plane.
TeamMetrics evaluate_trajectories(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                  int dimension, Association association = Association::kInterpolate);

}  // namespace radioslam
