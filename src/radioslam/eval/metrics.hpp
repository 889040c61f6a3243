// Trajectory error metrics: absolute trajectory error after one rigid alignment of the whole team, and
// relative pose error.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// Trajectory to be evaluated; `poses` in a frame common to the team.
struct EstimatedTrajectory {
  std::string id;
  Trajectory<SE3> poses;
  /// Stated standard deviation of each pose's position, as in RobotResult; may be empty.
  std::vector<double> sigma_position_m = {}, sigma_team_m = {};
  std::vector<std::pair<Stamp, Stamp>> untied = {};  ///< stretches without poses; not interpolated across
  std::vector<double> sigma_rad = {};                ///< of rotations, as sigma_position_m
};

/// Association of an estimate with the truth.
enum class Association {
  kInterpolate,  ///< the estimate is interpolated at the truth's stamps
  kNearest,      ///< as in evo: nearest stamps within 0.01 s
};

/// Statistics of position errors, metres; absent, not zero, if the estimate covers no truth.
struct ErrorStatistics {
  double rmse_m = 0;
  double mean_m = 0;
  double median_m = 0;
  double p90_m = 0;
  std::size_t count = 0;
};

/// Quantile of sorted values for a `fraction` in [0, 1], with linear interpolation (numpy's default). Needs
/// one value.
double quantile(const std::vector<double>& sorted, double fraction);

/// Nothing if there are no errors.
std::optional<ErrorStatistics> summarise_errors(std::vector<double> errors_m);

/// Error of one position.
struct PointError {
  Stamp stamp;
  double error_m = 0;
  double along_m = 0;                       ///< path length along the truth
  std::optional<double> sigma_m = {};       ///< stated standard deviation of the position, if there is one
  std::optional<double> sigma_team_m = {};  ///< the same in the gauge of the team, that of the error
  bool at_keyframe = false;                 ///< the nearest one to a pose of the estimate
};

/// Relative pose error over consecutive compared poses (evo's default, one frame apart), pooled over the
/// robots whose truth has an orientation.
struct RelativeError {
  double translation_rmse_m = 0;
  double rotation_rmse_rad = 0;
  std::size_t count = 0;
};

/// Errors over the standard deviations that were stated for them.
struct Consistency {
  double share_within_3_sigma = 0;
  double mean_square = 0;  ///< of the errors over sigma, per axis: 1 where sigma holds
};

/// Metrics of one robot.
struct RobotMetrics {
  std::string id;
  std::optional<ErrorStatistics> ate;
  double coverage = 0;
  std::vector<PointError> errors;
};

/// An estimate that fits the truth only after a reflection.
struct MirrorImage {
  std::string robot;  ///< empty: the whole team's
  double rigid_rmse_m = 0;
  double reflected_rmse_m = 0;
};

/// Metrics of the team after ONE rigid alignment of all robots together.
struct TeamMetrics {
  std::optional<ErrorStatistics> ate;
  std::optional<RelativeError> rpe;  ///< absent if no truth has an orientation
  /// Absolute rotation error after the alignment, over the robots whose truth has an orientation.
  std::optional<double> rotation_rmse_rad;
  /// Of all errors, with the uncertainty relative to what holds the frame; absent if not stated.
  std::optional<Consistency> consistency;
  /// In the gauge of the team, of the errors at keyframes: those between them are of the interpolation, too.
  /// Absent if a robot has no truth, since the alignment is not that of the gauge then.
  std::optional<Consistency> team_consistency;
  double coverage = 0;  ///< fraction of the truth's poses that the estimate covers
  SE3 T_truth_estimate;
  std::vector<RobotMetrics> robots;
  std::vector<MirrorImage> mirror_images;  ///< as in mirror_image.hpp
};

/// Compares `estimate` with `truth` (matched by id) after one alignment; with `dimension` 2, alignment and
/// errors are horizontal.
TeamMetrics evaluate_trajectories(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                  int dimension, Association association = Association::kInterpolate);

}  // namespace radioslam
