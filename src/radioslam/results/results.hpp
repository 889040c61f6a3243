// Result of a run: everything that is written, reported and evaluated.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/results/candidate_list.hpp"
#include "radioslam/results/map_result.hpp"

namespace radioslam {

// What a run found out about a device's RSSI offset, and about an access point's position.

/// Status of the RSSI offset of a robot's device from the team's mean.
enum class RssiOffsetStatus {
  kNotSought,       ///< disabled, or no fingerprints of this robot or of any other
  kNotObserved,     ///< too few pairs of fingerprints with every other robot
  kNotSignificant,  ///< estimated, but the team's offsets are within their errors
  kCorrected,
};

/// Status of an access point's position.
enum class AccessPointStatus {
  kFound,
  kAmbiguous,          ///< an alternative position fits nearly as well
  kPoorlyConstrained,  ///< its standard deviation is too large
};

/// Use of a robot's position fixes.
struct FixResult {
  std::size_t used = 0, rejected = 0;  ///< rejected: inconsistent with the estimate
  std::size_t outside = 0;             ///< at times without odometry
  bool place = false;                  ///< they place the robot in the common frame
  std::string unused;                  ///< reason why none was used; empty if some were
};

/// Consecutive keyframes behind a gap of the odometry that nothing ties to the rest of the trajectory.
struct UntiedStretch {
  Stamp first, last;
  std::size_t poses = 0;
};

/// Estimate of one robot. All robots of a component share one frame.
struct RobotResult {
  std::string id;
  Trajectory<SE3> estimate;  ///< T_frame_body at every keyframe
  Trajectory<SE3> dense;     ///< the same at every odometry sample from the first keyframe to the last
  Trajectory<SE3> odometry;  ///< the keyframes by odometry alone, placed by the initial pose or the first
                             ///< estimated pose
  std::vector<double>
      sigma_position_m;  ///< per keyframe, sqrt of the mean variance per axis; empty if not computed
  std::vector<double> sigma_team_m = {};  ///< the same in the gauge of the team (graph/team_gauge.hpp)
  std::vector<double> sigma_rad = {};     ///< as sigma_position_m, of rotations; in the plane, of the heading
  double yaw_drift_per_m_rad = 0;         ///< estimated
  double scale_error = 0;                 ///< estimated
  double rssi_offset_db = 0;              ///< of its device relative to the team's mean
  std::optional<double> sigma_rssi_offset_db = {};  ///< absent if unobservable
  RssiOffsetStatus rssi_offset = RssiOffsetStatus::kNotSought;
  std::vector<std::pair<Stamp, Stamp>> uncertain = {};  ///< stretches whose evidence was mostly rejected
  std::vector<UntiedStretch> untied = {};               ///< keyframes without a pose in its frame
  bool start_known = false;                             ///< the mission specifies its start
  bool placed = true;                                   ///< false: nothing connects it to its component
  std::optional<FixResult> fixes = {};                  ///< absent if it has none
};

/// Origin of a closure; kFile: a relative pose of a factor graph that is not odometry.
enum class ClosureKind { kRange, kAoa, kFingerprint, kSequence, kLidar, kMatch, kFile };
inline constexpr std::size_t kClosureKinds = 7;
enum class ClosureStatus { kAccepted, kRejected };

/// Constraint between two keyframes and its status.
struct ClosureResult {
  RobotIndex robot_i;
  Stamp stamp_i;  ///< of a keyframe
  RobotIndex robot_j;
  Stamp stamp_j;  ///< of a keyframe
  ClosureKind kind = ClosureKind::kFingerprint;
  ClosureStatus status = ClosureStatus::kAccepted;
  double statistic = 0;                   ///< squared normalised residual that was tested
  std::string reason;                     ///< of a rejection; empty if accepted
  std::vector<double> path_weights = {};  ///< of an angle: posterior that each of its paths is direct
  std::optional<SE3> T_i_j = {};          ///< measured, between the keyframes; absent if it is no pose
  std::optional<double> doubt = {};       ///< of a scan: probability that another place explains it
};

/// Bin of a fitted similarity-to-distance model.
struct SimilarityBin {
  double similarity = 0;  ///< centre
  double distance_m = 0;
  double sigma_m = 0;
  long samples = 0;
};

/// Similarity-to-distance model learnt from the fingerprints, for the report.
struct SimilarityModelResult {
  std::string measure;
  std::vector<SimilarityBin> bins;
  std::vector<std::pair<double, double>> samples;  ///< (similarity, distance in metres), thinned
};

/// Wall time of a pipeline stage.
struct StageTiming {
  std::string stage;
  double seconds = 0;
};

/// Parameter value used by the run.
struct EffectiveParameter {
  std::string key;
  std::string value;
  std::string unit;
  std::string description;
  bool changed = false;  ///< differs from the default
};

/// Constant error of the ranges between two antennas, measured = distance + bias. Each end is a robot or
/// anchor, followed by the antenna's name if it has one: "a/front".
struct RangeBiasResult {
  std::string end_i, end_j;
  double bias_m = 0;
  double sigma_m = 0;
  std::size_t ranges = 0;
};

/// A group of loops that agree with one another, held or dropped for a trial, and what the team would cost.
struct LoopTrialResult {
  std::vector<std::string> robots;  ///< one or two
  std::size_t loops = 0;
  bool held = false;  ///< for the trial; it was not before
  double cost = 0;
  bool taken = false;  ///< the solution that it led to
};

/// The choice among loops: sum of squares of the team, with every loop truncated, and what else was tried.
struct LoopChoiceResult {
  double cost = 0;  ///< at stated covariances
  std::vector<LoopTrialResult> trials;
};

/// Relative pose that the angles between two robots were tested against.
enum class CheckedPose {
  kSelfReported,  ///< self-reported: known starts and odometry
  kEstimate,      ///< the joint estimate
};

/// Consistency of the angles of arrival from one transmitter at one receiver with their relative pose.
struct AoaIntegrityResult {
  std::string receiver, transmitter;
  CheckedPose pose = CheckedPose::kEstimate;
  std::size_t measurements = 0;
  double median_weight = 0;  ///< weight of the relative pose under each measurement, 0 to 1
  double outlier_ratio = 0;  ///< fraction of measurements with no path near the predicted direction
  double p_value = 1;        ///< p-value of this disagreement for a truthful pair, both directions together
  bool contradicted = false;
};

/// Transform between two robots' odometry frames, at their first keyframes.
struct TransformResult {
  std::string robot_i, robot_j;
  SE3 T_i_j;  ///< takes points from j's odometry frame to i's
  /// In metres and radians, for a right perturbation T_i_j Exp(xi): 3 x 3 (x, y, yaw) in the plane, 6 x 6 in
  /// space.
  Eigen::MatrixXd covariance;
};

/// Robots that share one frame.
struct Component {
  std::vector<std::string> robots;
};

/// Alternative team alignment, less likely than the first.
struct HypothesisResult {
  double weight = 0;
  std::vector<RobotResult> robots;
};

/// Peak of an angle-of-arrival profile.
struct AoaPeakResult {
  double azimuth_rad = 0;  ///< in the receiver's body frame
  double sigma_rad = 0;
  double power_db = 0;         ///< relative to the strongest
  bool is_cross_term = false;  ///< artefact of the product of two paths
};

/// Angle of arrival estimated from channel state information.
struct MeasuredAoaResult {
  std::string receiver, transmitter;
  Stamp stamp;
  std::vector<AoaPeakResult> peaks;  ///< the strongest first
  std::vector<float> profile;        ///< power over body azimuth, evenly from -pi; maximum 1
  std::optional<double>
      estimated_azimuth_rad;   ///< direction to the transmitter in the body frame, by the final estimate
  std::vector<AoaPath> paths;  ///< paths that the run used, mirror solutions included
};

/// Access point located from signal strengths along the estimate, with its path loss model
/// P(d) = power_at_1m_dbm - 10 exponent log10(d / 1 m).
struct AccessPointResult {
  std::string bssid;
  double frequency_mhz = 0;
  AccessPointStatus status = AccessPointStatus::kFound;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< in the frame of the first component
  double power_at_1m_dbm = 0;
  double exponent = 0;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of [x, y, power, exponent]
  double sigma_db = 0;                                   ///< of a reading about the path loss model
  std::size_t readings = 0;                              ///< number of fingerprints that contain it
  std::optional<Eigen::Vector2d> alternative_m = {};     ///< second position that fits
  std::vector<Eigen::Vector3d> heard = {};               ///< [x, y, dBm] of some readings, for the report
};

/// Signal strength of one access point over time at one robot, for the strongest access points of the team.
struct SignalResult {
  std::string robot, bssid;
  std::vector<Stamp> stamps;
  std::vector<float> rss_dbm;
};

/// Similarity of one fingerprint to all others of the same robot.
struct SimilarityOverTime {
  std::string robot;
  Stamp of;
  std::vector<Stamp> stamps;
  std::vector<float> similarity;
};

/// What robots sent each other in a distributed overlap search. By robot, in the order of the mission.
struct ExchangeResult {
  std::vector<std::map<std::string, std::uint64_t>> bytes;  ///< by kind of message
  std::uint64_t rounds = 0;
  std::vector<std::uint64_t> log_bytes;  ///< what sending its log to every other robot takes; empty: unknown
};

/// Result of a run.
struct RunResult {
  std::string mission_name;
  int dimension = 2;
  std::vector<RobotResult> robots;  ///< in the order of the mission
  CandidateList candidates;         ///< those that are listed; counts["candidates"] is the number of all
  std::vector<ClosureResult> closures;
  std::optional<SimilarityModelResult> similarity_model;
  std::vector<RangeBiasResult> range_biases;        ///< those that are significant
  std::optional<LoopChoiceResult> loop_choice;      ///< where loops were judged together
  std::vector<MeasuredAoaResult> aoa_measurements;  ///< from channel state information
  std::vector<AoaIntegrityResult> angle_checks;
  std::vector<AccessPointResult> access_points;  ///< by BSSID; those detected at enough positions
  std::vector<SignalResult> signals;
  std::vector<SimilarityOverTime> similarity_over_time;
  std::vector<Component> components;
  std::vector<TransformResult> transforms;  ///< every two robots of one component; empty if not computed
  std::vector<std::string> unplaced;
  double weight = 1;                           ///< of `robots` among the hypotheses
  std::vector<HypothesisResult> alternatives;  ///< most likely first
  std::optional<ExchangeResult> exchange;      ///< of a distributed overlap search
  std::vector<MapResult> maps;                 ///< by component; of robots with scans
  std::map<std::string, double> counts;
  std::vector<StageTiming> timings;
  std::vector<EffectiveParameter> parameters;
  std::vector<std::string> notes;  ///< messages for the user
};

}  // namespace radioslam
