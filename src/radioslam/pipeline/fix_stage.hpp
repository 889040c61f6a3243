// Position fixes in the joint graph: robots are placed by them, and held by them.
//
// Every fix stands at a pose of its own, at its stamp, where the odometry is interpolated:
//   r = p + R l - fix,   covariance n sigma^2 per axis,
// l the antenna in the body frame, n the number of fixes within correlation_s, whose errors count as one.
// Their frame is the common one, in which known starts and anchors are told as well.
//
// A robot of unknown start is first laid onto its fixes as a rigid body (fix_alignment.hpp); then its way
// bends to those that hold (fix_growth.hpp), so that gross errors drop out. It is placed by its fixes
// where enough of them agree and are spread enough to give a heading. Fixes of other robots take part once
// something else has put them into the common frame. Where a robot of known start disagrees with its fixes,
// their frame is another one, and none of the team's fixes take part.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/team_placement.hpp"
#include "radioslam/team_frame/fix_alignment.hpp"

namespace radioslam {

struct FixParams {
  double correlation_s = 1;
  double gate_probability = 0.99;
  int least_fixes = 5;
  double least_share = 0.5;
  double most_sigma_yaw_rad = 0.1;
  FixAlignmentParams alignment;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"correlation_s", "s", 0, 1e4, "errors of fixes so near in time count as one"},
          self.correlation_s);
    visit(Field{"gate_probability", "", 0.5, 0.999999, "a fix is rejected beyond this quantile"},
          self.gate_probability);
    visit(Field{"least_fixes", "", 3, 1e6, "so many fixes must agree to place a robot"}, self.least_fixes);
    visit(Field{"least_share", "", 0, 1, "and this share of all of its fixes"}, self.least_share);
    visit(Field{"most_sigma_yaw_rad", "rad", 0.001, 3, "and be spread to give its heading so well"},
          self.most_sigma_yaw_rad);
    FixAlignmentParams::visit_fields(self.alignment, visit);
  }
};

/// What a robot's fixes are good for.
enum class FixRole {
  kNone,        ///< it has none within its odometry
  kPlace,       ///< they place it
  kHold,        ///< it is in the common frame by other means, and they hold it there
  kTooFew,      ///< too few to place it, and nothing else puts it into the common frame
  kTooClose,    ///< enough, but too close together to give its heading; likewise
  kDisagree,    ///< too few of them agree with each other and its odometry
  kOtherFrame,  ///< the fixes of a robot of known start contradict that start
};

constexpr bool takes_part(FixRole role) { return role == FixRole::kPlace || role == FixRole::kHold; }

/// The fixes of one robot.
template <class Pose>
struct RobotFixes {
  FixRole role = FixRole::kNone;
  std::vector<PositionFactor<Pose>> factors;  ///< their poses are at the fixes' stamps
  std::size_t first_factor = 0;               ///< in graph.positions, for roles kPlace and kHold
  std::size_t outside = 0;                    ///< fixes at times without odometry
  std::optional<SE3> T_common_start = {};     ///< of the odometry's frame, where they place it
};

template <class Pose>
using TeamFixes = std::vector<RobotFixes<Pose>>;

bool has_fixes(const Mission& mission);

/// Adds to every robot's moments the stamps of its fixes.
void add_fix_moments(const Mission& mission, std::vector<std::vector<Stamp>>& moments);

/// Moves the robots that can be placed by their fixes into the common frame and adds the fixes of these, and
/// of robots of known start, to the graph.
template <class Pose>
TeamFixes<Pose> place_by_fixes(JointGraph<Pose>& joint, const Mission& mission, const FixParams& params,
                               const OptimizerParams& optimizer);

/// The mission with the starts that the fixes gave; nothing where they gave none.
template <class Pose>
std::optional<Mission> with_placed_starts(const Mission& mission, const TeamFixes<Pose>& fixes);

/// Adds the fixes of robots that they did not place where the placement has put them into the common frame.
template <class Pose>
void hold_by_fixes(JointGraph<Pose>& joint, TeamFixes<Pose>& fixes, const TeamPlacement<Pose>& placement);

/// Judges all fixes anew in the optimised graph, and optimises again as long as verdicts change.
template <class Pose>
void settle_fixes(JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes, const OptimizerParams& optimizer,
                  const Progress& progress);

}  // namespace radioslam
