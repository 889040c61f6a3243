// Joint graph of a whole team, with the meaning of its variables and factors: odometry with constant drift,
// known starts and headings, radio links, anchors and closures.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/graph/team_graph.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

// Where each factor of the joint graph came from: which measurement, robots and keyframes.

/// Kind of measurement that a factor was made from.
enum class FactorSource { kOdometry, kRange, kAoa, kFingerprint, kSequence, kScanLoop, kLoop };

struct FactorOrigin {
  FactorSource source = FactorSource::kOdometry;
  /// Index among the measurements of its source: ranges, angles of arrival and matches of the mission,
  /// proposed closures, or the robot's odometry steps.
  std::size_t measurement = 0;
  RobotIndex robot_i, robot_j;   ///< invalid for an anchor
  Stamp stamp_i, stamp_j;        ///< of the keyframes at or before both ends
  std::size_t antenna_pair = 0;  ///< of a range: index into JointGraph::antenna_pairs
};

/// The origins of a joint graph's factors: one entry per factor of each list, in the same order.
struct FactorOrigins {
  std::vector<FactorOrigin> relative_poses;  ///< of team.graph.relative_poses
  std::vector<FactorOrigin> ranges;          ///< of team.graph.ranges
  std::vector<FactorOrigin> bearings;        ///< of team.bearings
};

/// Indices of the factors of one source.
std::vector<std::size_t> factors_of(const std::vector<FactorOrigin>& origins, FactorSource source);

struct JointGraphParams {
  double sigma_start_m = 0.05;
  double sigma_start_rad = 0.01;
  double sigma_level_rad = 0.03;
  double min_sigma_yaw_drift_per_m_rad = 1e-3;
  double min_sigma_scale = 0.02;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(sigma_start_m, "m", 1e-4, 100,
                          "standard deviation of a known initial position, per axis");
    RADIOSLAM_BASIC_FIELD(sigma_start_rad, "rad", 1e-5, 3,
                          "standard deviation of a known initial orientation");
    RADIOSLAM_FIELD(
        sigma_level_rad, "rad", 1e-4, 1,
        "standard deviation of the odometry's roll and pitch, which are taken from gravity (space only)");
    RADIOSLAM_FIELD(min_sigma_yaw_drift_per_m_rad, "rad/m", 0, 1,
                    "lower bound on the prior sigma of constant yaw drift (1e-3: 57 deg/km), for robots with "
                    "WiFi scans or position fixes");
    RADIOSLAM_FIELD(min_sigma_scale, "", 0, 1,
                    "lower bound on the prior sigma of the odometry scale error, for robots with WiFi scans "
                    "or position fixes");
  }
};

/// A robot's variables in the graph.
struct RobotVariables {
  std::string id;
  std::vector<Stamp> stamps;
  std::vector<PoseId> poses;
  std::vector<SE3> odometry;          ///< T_start_keyframe, as recorded
  DriftId drift;                      ///< invalid: not estimated
  std::optional<SE3> T_common_start;  ///< start of the odometry frame as given by the mission
  bool placed_by_fixes = false;       ///< the robot's position fixes put it into the common frame
  std::vector<UntiedStretch> untied;  ///< keyframes that are left out above, since nothing ties them to these
  double lidar_range_m = 0;
  double lidar_view_rad = 0;
};

/// Weight of a bearing after the team alignment.
struct BearingWeight {
  double weight = 0;               ///< sum over the paths in use
  std::vector<double> paths = {};  ///< posterior of every path
  bool too_near = false;           ///< too close: the antennas' position errors dominate the angle
};

template <class Pose>
struct JointGraph {
  TeamGraph<Pose> team;
  std::vector<RobotVariables> robots;
  FactorOrigins origins;                                           ///< one per factor
  std::vector<std::size_t> robot_of_segment;                       ///< per team.segments
  std::vector<std::pair<std::string, std::string>> antenna_pairs;  ///< as in RangeBiasResult
  std::vector<BearingWeight> bearing_weights;  ///< per team.bearings, once the team is placed; empty before
  std::size_t ignored_links = 0;               ///< radio links at times without odometry
};

/// Adds a factor together with its origin, so that the two lists stay in step.
template <class Pose>
void add_factor(JointGraph<Pose>& joint, const RelativePoseFactor<Pose>& factor, const FactorOrigin& origin) {
  joint.team.graph.relative_poses.push_back(factor);
  joint.origins.relative_poses.push_back(origin);
}
template <class Pose>
void add_factor(JointGraph<Pose>& joint, const RangeFactor<Pose>& factor, const FactorOrigin& origin) {
  joint.team.graph.ranges.push_back(factor);
  joint.origins.ranges.push_back(origin);
}
template <class Pose>
void add_factor(JointGraph<Pose>& joint, AmbiguousBearing<Pose> factor, const FactorOrigin& origin) {
  joint.team.bearings.push_back(std::move(factor));
  joint.origins.bearings.push_back(origin);
}

/// Erases the relative poses of which this holds of the origin.
template <class Pose, class Predicate>
void erase_relative_poses(JointGraph<Pose>& joint, const Predicate& is_erased) {
  auto& factors = joint.team.graph.relative_poses;
  auto& origins = joint.origins.relative_poses;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    if (is_erased(origins[k])) continue;
    factors[kept] = factors[k];
    origins[kept++] = origins[k];
  }
  factors.resize(kept);
  origins.resize(kept);
}

/// Stamp of the robot's keyframe at or before `stamp`.
template <class Pose>
Stamp keyframe_stamp(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp) {
  const auto& stamps = joint.robots[robot.index()].stamps;
  return stamps[keyframe_before(stamps, stamp)];
}

/// The robot's pose at exactly this stamp; invalid if it has none.
template <class Pose>
PoseId pose_at(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp);

/// Start of the odometry frame in the common frame, from the mission's known start; its first pose has the
/// known height.
std::optional<SE3> common_from_start(const Robot& robot);

/// Graph without closures, of the robots' keyframes. Trajectories are in their own start frames, or in the
/// common frame if their start is known.
template <class Pose>
JointGraph<Pose> build_joint_graph(const Mission& mission, const KeyframeParams& keyframes,
                                   const JointGraphParams& params);

/// Moves every robot's trajectory rigidly: poses <- T_team_start * poses.
template <class Pose>
void place_robots(JointGraph<Pose>& joint, const std::vector<SE2>& T_team_start);

/// Positions of the fingerprints `radio.nodes`, in metres.
template <class Pose>
Eigen::Matrix3Xd fingerprint_places(const JointGraph<Pose>& joint, const RadioMeasurements& radio);

/// Adds ranges with the distances predicted from fingerprint similarity.
template <class Pose>
void add_fingerprint_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                              const std::vector<FingerprintClosure>& closures);

}  // namespace radioslam
