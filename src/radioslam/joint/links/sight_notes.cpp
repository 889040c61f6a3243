#include "radioslam/joint/links/sight_notes.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinLinks = 6;    // fewer may all be obstructed by chance
constexpr std::size_t kMinInSight = 3;  // as many as fix x, y and heading

struct LinkCounts {
  std::size_t links = 0, in_sight = 0, other_closures = 0;
};

LinkCounts count_links(RobotIndex robot, const std::vector<ClosureResult>& closures) {
  LinkCounts counts;
  for (const ClosureResult& closure : closures) {
    if (closure.robot_i == closure.robot_j || (closure.robot_i != robot && closure.robot_j != robot))
      continue;
    const bool is_accepted = closure.status == ClosureStatus::kAccepted;
    const bool is_link = closure.kind == ClosureKind::kRange || closure.kind == ClosureKind::kAoa;
    if (is_link) ++counts.links;
    if (is_accepted) ++(is_link ? counts.in_sight : counts.other_closures);
  }
  return counts;
}

}  // namespace

std::vector<std::string> notes_on_obstructed_robots(const std::vector<RobotResult>& robots,
                                                    const std::vector<ClosureResult>& closures) {
  std::vector<std::string> notes;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    if (!robots[r].placed || robots[r].start_known) continue;
    const LinkCounts counts = count_links(RobotIndex(r), closures);
    if (counts.links < kMinLinks || counts.in_sight >= kMinInSight || counts.other_closures > 0) continue;
    notes.push_back("the place of robot " + robots[r].id + " is uncertain: " +
                    std::to_string(counts.in_sight) + " of its " + std::to_string(counts.links) +
                    " ranges and angles to other robots agree with it, the others are detours or false");
  }
  return notes;
}

}  // namespace radioslam
