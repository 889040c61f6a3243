// What a run produced: everything that is written, reported and evaluated, and nothing else.
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

namespace radioslam {

/// What became of the offset of a robot's device.
enum class RssiOffset { kNotSought, kNotObserved, kNotShown, kTakenOff };

/// What became of a robot's position fixes.
struct FixResult {
  std::size_t used = 0, rejected = 0;  ///< rejected: contradicted by the estimate
  std::size_t outside = 0;             ///< at times without odometry
  bool place = false;                  ///< they put the robot into the common frame
  std::string unused;                  ///< why none took part; empty where they did
};

/// A cell of a picture from above.
struct ScanCell {
  std::int32_t x = 0, y = 0;  ///< from x * cell_m to (x + 1) * cell_m, likewise y
  int hits = 0;               ///< scans that hit it; of scanners in space, heights
};

/// What a robot's scans show from above, in the frame of its estimate.
struct ScanPictureResult {
  double cell_m = 0;
  std::size_t scans = 0;        ///< that were taken
  std::vector<ScanCell> cells;  ///< by y, then by x
};

/// A robot's estimated keyframes. All robots of one component share one frame.
struct RobotResult {
  std::string id;
  Trajectory<SE3> estimate;  ///< T_frame_body at every keyframe
  Trajectory<SE3> dense;     ///< the same at every row of the odometry from the first keyframe to the last
  Trajectory<SE3> odometry;  ///< the same keyframes by odometry alone, placed by the initial pose (or the
                             ///< first estimated pose)
  std::vector<double>
      sigma_position_m;  ///< per keyframe, sqrt of the mean variance per axis; empty if not computed
  double yaw_drift_per_m_rad = 0;  ///< estimated
  double scale_error = 0;          ///< estimated
  double rssi_offset_db = 0;       ///< its device hears so much stronger than the team's mean
  std::optional<double> sigma_rssi_offset_db = {};  ///< absent where nothing tells
  RssiOffset rssi_offset = RssiOffset::kNotSought;
  bool start_known = false;                       ///< the mission said where it starts
  bool placed = true;                             ///< false: nothing ties it to its component
  std::optional<FixResult> fixes = {};            ///< absent where it has none
  std::optional<ScanPictureResult> picture = {};  ///< absent where it has no scans
};

/// Where a closure came from.
enum class ClosureKind { kRange, kAoa, kFingerprint, kSequence, kLidar, kMatch };
enum class ClosureStatus { kAccepted, kRejected };

/// One tie between two keyframes and what became of it.
struct ClosureResult {
  RobotIndex robot_i;
  Stamp stamp_i;  ///< a keyframe's
  RobotIndex robot_j;
  Stamp stamp_j;  ///< a keyframe's
  ClosureKind kind = ClosureKind::kFingerprint;
  ClosureStatus status = ClosureStatus::kAccepted;
  double statistic = 0;  ///< the squared normalised residual that decided
  std::string reason;    ///< of a rejection; empty when accepted
};

/// A pair of keyframes of different robots that survived pruning.
struct CandidateResult {
  RobotIndex robot_i;
  Stamp stamp_i;
  RobotIndex robot_j;
  Stamp stamp_j;
  double distance_m = 0;
  double mahalanobis = 0;
};

/// One bin of a fitted similarity-to-distance model, with samples for the picture.
struct SimilarityBin {
  double similarity = 0;  ///< centre
  double distance_m = 0;
  double sigma_m = 0;
  long samples = 0;
};

/// What the fingerprints taught: for the report.
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

/// One parameter as it was used.
struct EffectiveParameter {
  std::string key;
  std::string value;
  std::string unit;
  std::string meaning;
  bool changed = false;  ///< differs from the default
};

/// The constant error of the ranges between two antennas, each told as its robot or anchor and, where it has
/// one, its name: "a/front". measured = distance + bias.
struct RangeBiasResult {
  std::string end_i, end_j;
  double bias_m = 0;
  double sigma_m = 0;
  std::size_t ranges = 0;
};

/// Whose relative pose the angles between two robots were held against.
enum class CheckedPose {
  kClaim,     ///< what both report of themselves: known start and odometry
  kEstimate,  ///< the joint estimate
};

/// What the angles at which one robot heard another one, or an anchor, say of where it is.
struct AngleCheckResult {
  std::string receiver, transmitter;
  CheckedPose pose = CheckedPose::kEstimate;
  std::size_t measurements = 0;
  double median_weight = 0;  ///< of the relative pose under each measurement, 0 to 1
  double share_beyond = 0;   ///< of the measurements with no path near the predicted direction
  double chance = 1;         ///< that an honest pair, both directions together, is contradicted so much
  bool contradicted = false;
};

/// How the frames of two robots' odometries lie to each other, at the robots' first keyframes.
struct TransformResult {
  std::string robot_i, robot_j;
  SE3 T_i_j;  ///< takes points of j's odometry frame to i's
  /// Of [metres; radians] for a right perturbation T_i_j Exp(xi): 3 x 3 (x, y, yaw) in the plane, 6 x 6 in
  /// space.
  Eigen::MatrixXd covariance;
};

/// Robots that share one frame.
struct Component {
  std::vector<std::string> robots;
};

/// Another way the team may lie, less likely than the first.
struct HypothesisResult {
  double weight = 0;
  std::vector<RobotResult> robots;
};

/// A direction of one measurement.
struct ArrivalPeakResult {
  double azimuth_rad = 0;  ///< in the receiver's body frame
  double sigma_rad = 0;
  double power_db = 0;    ///< to the strongest
  bool is_ghost = false;  ///< a product of two paths, between them
};

/// Directions measured out of channel state information.
struct MeasuredArrivalResult {
  std::string receiver, transmitter;
  Stamp stamp;
  std::vector<ArrivalPeakResult> peaks;  ///< the strongest first
  std::vector<float> profile;            ///< power over body azimuth from -pi, evenly; the strongest 1
  std::optional<double>
      estimated_azimuth_rad;       ///< of the transmitter, in the body frame, by the final estimate
  std::vector<ArrivalPath> paths;  ///< that the run took of the peaks, with mirror images
};

/// Whether the place of an access point is known.
enum class AccessPointKnown {
  kFound,
  kAmbiguous,  ///< it may as well be at its rival
  kLoose,      ///< anywhere around
};

/// Where an access point is, by how strongly it was heard along the estimate, and how it sounds:
/// P(d) = power_at_1m_dbm - 10 exponent log10(d / 1 m).
struct AccessPointResult {
  std::string bssid;
  double frequency_mhz = 0;
  AccessPointKnown known = AccessPointKnown::kFound;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< in the frame of the first component
  double power_at_1m_dbm = 0;
  double exponent = 0;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of [x, y, power, exponent]
  double sigma_db = 0;                                   ///< of a reading about that law
  std::size_t readings = 0;                              ///< fingerprints that hold it
  std::optional<Eigen::Vector2d> rival_m = {};           ///< where it may be as well
  std::vector<Eigen::Vector3d> heard = {};               ///< [x, y, dBm] of a few readings, for the picture
};

/// How strongly some of the access points were heard along one robot's way; the strongest of all robots.
struct SignalResult {
  std::string robot, bssid;
  std::vector<Stamp> stamps;
  std::vector<float> rss_dbm;
};

/// How alike one fingerprint of a robot is to every other one of the same robot.
struct SimilarityOverTime {
  std::string robot;
  Stamp of;
  std::vector<Stamp> stamps;
  std::vector<float> similarity;
};

/// A whole run.
struct RunResult {
  std::string mission_name;
  int dimension = 2;
  std::vector<RobotResult> robots;  ///< in the mission's order
  std::vector<CandidateResult> candidates;
  std::vector<ClosureResult> closures;
  std::optional<SimilarityModelResult> similarity_model;
  std::vector<RangeBiasResult> range_biases;    ///< those that show
  std::vector<MeasuredArrivalResult> arrivals;  ///< out of channel state information
  std::vector<AngleCheckResult> angle_checks;
  std::vector<AccessPointResult> access_points;  ///< by BSSID; those heard in enough places
  std::vector<SignalResult> signals;
  std::vector<SimilarityOverTime> similarity_over_time;
  std::vector<Component> components;
  std::vector<TransformResult> transforms;  ///< every two robots of one component; empty if not computed
  std::vector<std::string> unplaced;
  double weight = 1;                           ///< of `robots` among the hypotheses
  std::vector<HypothesisResult> alternatives;  ///< likeliest first
  std::map<std::string, double> counts;
  std::vector<StageTiming> timings;
  std::vector<EffectiveParameter> parameters;
  std::vector<std::string> notes;  ///< what a user should know (odometry noise looks larger than stated, ...)
};

}  // namespace radioslam
