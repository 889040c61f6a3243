#include "radioslam/pipeline/fix_results.hpp"

#include <string>

namespace radioslam {
namespace {

/// Why a robot's fixes took no part; empty where they did.
std::string why_not(FixRole role) {
  switch (role) {
    case FixRole::kNone:
    case FixRole::kPlace:
    case FixRole::kHold:
      return "";
    case FixRole::kTooFew:
      return "too few to place it";
    case FixRole::kTooClose:
      return "too close together to give its heading";
    case FixRole::kDisagree:
      return "too few of them agree with each other and the odometry";
    case FixRole::kOtherFrame:
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
    robot.unused = why_not(fixes[r].role);
    robot.place = fixes[r].role == FixRole::kPlace;
    robot.outside = fixes[r].outside;
    for (std::size_t k = 0; k < fixes[r].factors.size() && takes_part(fixes[r].role); ++k)
      ++(joint.team.graph.positions[fixes[r].first_factor + k].weight > 0 ? robot.used : robot.rejected);
    result.counts["fixes"] += static_cast<double>(all);
    result.counts["fixes_used"] += static_cast<double>(robot.used);
    result.counts["fixes_rejected"] += static_cast<double>(robot.rejected);
    if (!robot.unused.empty())
      result.notes.push_back("robot " + result.robots[r].id + ": its " + fixes_text(all) +
                             " took no part: " + robot.unused);
    else if (robot.rejected > 0)
      result.notes.push_back("robot " + result.robots[r].id + ": " + std::to_string(robot.rejected) + " of " +
                             fixes_text(robot.used + robot.rejected) +
                             " contradict the estimate and were left out");
    if (robot.outside > 0 && robot.unused.empty())
      result.notes.push_back("robot " + result.robots[r].id + ": " + fixes_text(robot.outside) +
                             " lie outside the time of its odometry");
  }
}

template void add_fix_results(RunResult&, const JointGraph<SE2>&, const TeamFixes<SE2>&);
template void add_fix_results(RunResult&, const JointGraph<SE3>&, const TeamFixes<SE3>&);

}  // namespace radioslam
