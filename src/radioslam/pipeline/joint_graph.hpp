// The graph of a whole team and what its parts stand for: every robot's odometry with its constant drift,
// known starts and headings, radio links, anchors, and the ties that closures add.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/team_graph.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct JointGraphParams {
  double sigma_start_m = 0.05;  ///< of a known initial pose
  double sigma_start_rad = 0.01;
  double least_sigma_yaw_drift_per_m_rad = 1e-3;  ///< where fingerprints or fixes tell
  double least_sigma_scale = 0.02;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"sigma_start_m", "m", 1e-4, 100, "error of a known initial position"}, self.sigma_start_m);
    visit(Field{"sigma_start_rad", "rad", 1e-5, 3, "error of a known initial yaw"}, self.sigma_start_rad);
    visit(Field{"least_sigma_yaw_drift_per_m_rad", "rad/m", 0, 1,
                "prior of the constant yaw drift of robots with WiFi scans or position fixes where a smaller "
                "one is "
                "stated: 57 degrees per km"},
          self.least_sigma_yaw_drift_per_m_rad);
    visit(Field{"least_sigma_scale", "", 0, 1, "prior of their odometry's scale error, likewise"},
          self.least_sigma_scale);
  }
};

/// A robot and the poses of its keyframes.
struct JointRobot {
  std::string id;
  std::vector<Stamp> stamps;
  std::vector<PoseId> poses;
  std::vector<SE3> odometry;          ///< T_start_keyframe, as recorded
  DriftId drift;                      ///< invalid: not estimated
  std::optional<SE3> T_common_start;  ///< where the mission says that the odometry's frame is
  bool placed_by_fixes = false;       ///< its position fixes put it into the common frame
  double lidar_range_m = 0;
  double lidar_view_rad = 0;
};

/// Which keyframes a radio factor of the graph ties; a tie to an anchor has no robot j.
struct RadioTie {
  RobotIndex robot_i, robot_j;
  Stamp stamp_i, stamp_j;
};

/// What the alignment made of a bearing.
struct BearingVerdict {
  double weight = 0;      ///< of its paths that take part, together
  bool too_near = false;  ///< the robots stood so close that the antennas' places decide the angle
};

template <class Pose>
struct JointGraph {
  TeamGraph<Pose> team;
  std::vector<JointRobot> robots;
  std::vector<std::size_t> robot_of_piece;  ///< per team.pieces
  std::vector<RadioTie> range_ties;         ///< of the first team.graph.ranges
  std::vector<std::size_t> range_pairs;     ///< of the same ranges, which of the antenna pairs they belong to
  std::vector<std::pair<std::string, std::string>> antenna_pairs;  ///< as in RangeBiasResult
  std::vector<RadioTie> bearing_ties;                              ///< of team.bearings
  std::vector<BearingVerdict> bearing_verdicts;  ///< likewise, once the team is placed; empty before
  std::size_t first_closure_range = 0;  ///< team.graph.ranges from here on belong to the closures, in order
  std::size_t ignored_links = 0;        ///< radio links outside the time of an odometry
};

/// chi-squared of a relative pose, 99 %: 3 and 6 degrees of freedom.
template <class Pose>
inline constexpr double kPoseChiSquared99 = Pose::kDof == 3 ? 11.345 : 16.812;

/// The pose of a robot at exactly this stamp, which select_nodes made; invalid outside its odometry.
template <class Pose>
PoseId pose_at(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp);

/// Where the mission says that a robot's odometry starts, its first pose at the height of the known one.
std::optional<SE3> common_from_start(const Robot& robot);

/// Everything but closures. Every trajectory stands in its own start frame, or where its start is known.
/// `moments`: per robot, further times of its odometry at which poses stand; empty: none.
template <class Pose>
JointGraph<Pose> build_joint_graph(const Mission& mission, const KeyframeParams& keyframes,
                                   const JointGraphParams& params,
                                   std::vector<std::vector<Stamp>> moments = {});

/// Moves every robot's trajectory rigidly: poses <- T_team_start * poses.
template <class Pose>
void place_robots(JointGraph<Pose>& joint, const std::vector<SE2>& T_team_start);

/// Where node `node` of `radio` was: fixed to the keyframe before it.
template <class Pose>
RangeEnd<Pose> fingerprint_end(const JointGraph<Pose>& joint, const RadioMeasurements& radio,
                               std::size_t node);

/// The distances that fingerprints predict.
template <class Pose>
void add_fingerprint_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                              const std::vector<FingerprintClosure>& closures);

}  // namespace radioslam
