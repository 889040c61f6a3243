#include "radioslam/joint/position_fixes/fix_results.hpp"

#include <string>

namespace radioslam {
namespace {

/// Why a robot's fixes are not used; empty if they are.
std::string reason_unused(FixUse role) {
  switch (role) {
    case FixUse::kNone:
    case FixUse::kPlacesRobot:
    case FixUse::kConstrainsRobot:
      return "";
    case FixUse::kTooFew:
      return "too few to place it";
    case FixUse::kNoBaseline:
      return "too close together to give its heading";
    case FixUse::kInconsistent:
      return "too few of them agree with each other and the odometry";
    case FixUse::kForeignFrame:
      return "their frame is not that of the known starts";
  }
  return "";
}

std::string fixes_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " position fix" : " position fixes");
}

}  // namespace

template <class Pose>
void add_fix_results(RunResult& result, const JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes) {
  for (std::size_t r = 0; r < fixes.size(); ++r) {
    const std::size_t all = fixes[r].factors.size() + fixes[r].outside;
    if (all == 0) continue;
    FixResult& robot = result.robots[r].fixes.emplace();
    robot.unused = reason_unused(fixes[r].role);
    robot.place = fixes[r].role == FixUse::kPlacesRobot;
    robot.outside = fixes[r].outside;
    for (std::size_t k = 0; k < fixes[r].factors.size() && takes_part(fixes[r].role); ++k)
      ++(joint.team.graph.positions[fixes[r].first_factor + k].weight > 0 ? robot.used : robot.rejected);
    result.counts["fixes"] += static_cast<double>(all);
    result.counts["fixes_used"] += static_cast<double>(robot.used);
    result.counts["fixes_rejected"] += static_cast<double>(robot.rejected);
    if (!robot.unused.empty())
      result.notes.push_back("robot " + result.robots[r].id + ": its " + fixes_text(all) +
                             " are not used: " + robot.unused);
    else if (robot.rejected > 0)
      result.notes.push_back("robot " + result.robots[r].id + ": " + std::to_string(robot.rejected) + " of " +
                             fixes_text(robot.used + robot.rejected) +
                             " contradict the estimate and were rejected");
    if (robot.outside > 0 && robot.unused.empty())
      result.notes.push_back("robot " + result.robots[r].id + ": " + fixes_text(robot.outside) +
                             " have no odometry at their time");
  }
}

template void add_fix_results(RunResult&, const JointGraph<SE2>&, const TeamFixes<SE2>&);
template void add_fix_results(RunResult&, const JointGraph<SE3>&, const TeamFixes<SE3>&);

}  // namespace radioslam
