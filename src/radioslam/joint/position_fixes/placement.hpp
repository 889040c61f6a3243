// Position fixes (GNSS or other) in the joint graph: they place robots of unknown start and constrain the
// rest.
//
// Every fix is attached to a pose of its own, at its stamp on the interpolated odometry:
//   r = p + R l - fix,   covariance n sigma^2 per axis,
// l being the antenna's lever arm and n the number of fixes within correlation_s, whose errors count as one.
// Fixes are given in the common frame, like known starts and anchors.
//
// A robot of unknown start is first aligned with its fixes as a rigid body (team_frame/fix_alignment.hpp);
// its trajectory is then fitted to the inliers (inlier_growth.hpp), which rejects gross errors. The fixes
// place it if enough of them agree and their baseline determines a heading. Fixes of other robots are used
// once something else has put these into the common frame. If a robot of known start disagrees with its
// fixes, their frame is a foreign one, and none of the team's fixes are used.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/team_frame/fix_alignment.hpp"

namespace radioslam {

// Inlier growth for position fixes: starts from seeds and follows the path, so that fixes near inliers are
// classified first, while the odometry in between is still accurate.
//
// Optimizing with all fixes at once would pull the trajectory towards a run of wrong fixes until it fits
// them. Instead, each round fits the trajectory to the current inliers (Geman-McClure loss); a fix then
// passes if
//   r^2 <= gate (sigma^2 + u^2),   u = max_drift_ratio * path length to the nearest inlier.
// Inliers that do not pass are removed. Fixes that pass are added if u < sigma, or if u <= reach times the
// smallest u of those that pass: a gap in the fixes is crossed from its edge. Ends when the inliers no longer
// change, or after max_rounds. Cost: one optimization of all robots per round.

/// A robot's fixes in temporal order, with their inliers.
template <class Pose>
struct FixInliers {
  std::vector<PositionFactor<Pose>> factors;
  std::vector<FixAlongPath> along_path;  ///< same order as factors
  std::vector<double> seeds_m;           ///< path lengths at which the initial values are right
  std::vector<bool> holds;               ///< is an inlier; initially none is
};

/// Parameters of the growth only.
struct FixGrowthParams {
  double gate = 9.21;             ///< chi-squared
  double max_drift_ratio = 0.03;  ///< odometry drift per path length
  double reach = 1.25;            ///< see above
  int max_rounds = 200;
};

/// Fits graph.poses and drifts to the inliers, and finds these. graph.positions must be empty and is left
/// empty. Initial values must be close to the fixes at every robot's seeds.
template <class Pose>
void grow_inliers(PoseGraph<Pose>& graph, std::vector<FixInliers<Pose>>& team, const FixGrowthParams& params,
                  const OptimizerParams& optimizer);

struct FixParams {
  double correlation_s = 1;
  double gate_probability = 0.99;
  int min_fixes = 5;
  double min_inlier_ratio = 0.5;
  double max_sigma_yaw_rad = 0.1;
  FixAlignmentParams alignment;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(correlation_s, "s", 0, 1e4,
                    "time within which the errors of fixes count as one; higher values reduce their weight");
    RADIOSLAM_BASIC_FIELD(gate_probability, "", 0.5, 0.999999,
                          "chi-squared quantile beyond which a fix is rejected; higher values keep more "
                          "fixes but admit false ones");
    RADIOSLAM_BASIC_FIELD(min_fixes, "", 3, 1e6, "smallest number of consistent fixes that place a robot");
    RADIOSLAM_FIELD(min_inlier_ratio, "", 0, 1,
                    "smallest inlier ratio of a robot's fixes for them to be used");
    RADIOSLAM_FIELD(max_sigma_yaw_rad, "rad", 0.001, 3,
                    "largest standard deviation of the heading that fixes must determine to place a robot");
    FixAlignmentParams::visit_fields(self.alignment, visit);
  }
};

/// How a robot's fixes are used.
enum class FixUse {
  kNone,             ///< no fixes within its odometry
  kPlacesRobot,      ///< they put it into the common frame
  kConstrainsRobot,  ///< used; the robot is in the common frame by other means
  kTooFew,           ///< too few to place it, and nothing else puts it into the common frame
  kNoBaseline,       ///< enough, but with too short a baseline for its heading; nothing else places it either
  kInconsistent,     ///< too few of them agree with each other and the odometry
  kForeignFrame,     ///< fixes of a robot of known start contradict that start
};

constexpr bool takes_part(FixUse role) {
  return role == FixUse::kPlacesRobot || role == FixUse::kConstrainsRobot;
}

/// The fixes of one robot.
template <class Pose>
struct RobotFixes {
  FixUse role = FixUse::kNone;
  std::vector<PositionFactor<Pose>> factors;  ///< on poses at the fixes' stamps
  std::size_t first_factor = 0;               ///< in graph.positions, for kPlacesRobot and kConstrainsRobot
  std::size_t outside = 0;                    ///< fixes at times without odometry
  std::optional<SE3> T_common_start = {};     ///< start of the odometry frame, if they place the robot
};

template <class Pose>
using TeamFixes = std::vector<RobotFixes<Pose>>;

bool has_fixes(const Mission& mission);

/// Moves robots that their fixes can place into the common frame, and adds their fixes and those of robots of
/// known start to the graph.
template <class Pose>
TeamFixes<Pose> place_by_fixes(JointGraph<Pose>& joint, const Mission& mission, const FixParams& params,
                               const OptimizerParams& optimizer);

/// The stated starts, and those that the fixes determined.
template <class Pose>
KnownStarts starts_with_fixes(KnownStarts starts, const Mission& mission, const TeamFixes<Pose>& fixes);

/// Adds fixes of robots that other measurements have put into the common frame.
template <class Pose>
void constrain_by_fixes(JointGraph<Pose>& joint, TeamFixes<Pose>& fixes,
                        const TeamAlignment<Pose>& alignment);

/// Reclassifies all fixes in the optimized graph, and optimizes again until their classes no longer change.
template <class Pose>
void reclassify_fixes(JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes, const OptimizerParams& optimizer,
                      const Progress& progress);

// Results of position fixes: counts and notes of a run.

/// Adds the robots' fixes, their counts, and notes on those that are not used.
template <class Pose>
void add_fix_results(RunResult& result, const JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes);

}  // namespace radioslam
