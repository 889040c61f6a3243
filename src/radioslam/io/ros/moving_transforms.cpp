#include "radioslam/io/ros/moving_transforms.hpp"

#include <algorithm>
#include <deque>
#include <set>

namespace radioslam {
namespace {

/// Sorts by time; of several poses with the same stamp the first is kept.
Trajectory<SE3> in_order_of_time(std::vector<StampedPose<SE3>> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  poses.erase(std::unique(poses.begin(), poses.end(),
                          [](const auto& a, const auto& b) { return a.stamp == b.stamp; }),
              poses.end());
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace

void MovingTransforms::take(const RosMessage& message) {
  for (const RosPose& transform : read_ros_transforms(message)) {
    Link& link = links_[{transform.header.frame, transform.child}];
    if (!transform.pose) {
      ++link.without_pose;
      continue;
    }
    if (transform.header.stamp == Stamp{}) ++link.without_time;
    link.poses.push_back({time_of(message, transform.header), *transform.pose});
  }
}

std::optional<MovingTransforms::Step> MovingTransforms::step_over(const FrameTree& fixed,
                                                                  const std::string& from,
                                                                  Links::const_iterator link) const {
  const auto& [parent, child] = link->first;
  if (const auto T = fixed.find(from, parent)) return Step{link, *T, false};
  if (const auto T = fixed.find(from, child)) return Step{link, *T, true};
  return std::nullopt;
}

std::optional<MovingTransforms::Chain> MovingTransforms::find_chain(const FrameTree& fixed,
                                                                    const std::string& frame,
                                                                    const std::string& child) const {
  std::deque<std::vector<Step>> chains{{}};
  std::set<const Link*> seen;
  for (; !chains.empty(); chains.pop_front()) {
    const std::vector<Step> steps = chains.front();
    const std::string& at = steps.empty() ? frame : steps.back().target();
    if (!steps.empty())
      if (const auto T_behind = fixed.find(at, child)) return Chain{steps, *T_behind};
    for (auto link = links_.begin(); link != links_.end(); ++link) {
      if (seen.contains(&link->second)) continue;
      const auto step = step_over(fixed, at, link);
      if (!step) continue;
      seen.insert(&link->second);
      chains.push_back(steps);
      chains.back().push_back(*step);
    }
  }
  return std::nullopt;
}

TransformedPoses MovingTransforms::find(const FrameTree& fixed, const std::string& frame,
                                        const std::string& child) const {
  TransformedPoses found;
  const auto chain = find_chain(fixed, frame, child);
  if (!chain) return found;
  std::vector<Trajectory<SE3>> links;
  std::size_t most = 0;
  for (std::size_t k = 0; k < chain->steps.size(); ++k) {
    const Link& link = chain->steps[k].link->second;
    found.without_pose += link.without_pose;
    found.without_time += link.without_time;
    if (link.poses.size() >= chain->steps[most].link->second.poses.size()) most = k;
    links.push_back(in_order_of_time(link.poses));
  }
  for (const StampedPose<SE3>& timed : chain->steps[most].link->second.poses) {
    std::optional<SE3> T_frame_child = SE3();
    for (std::size_t k = 0; T_frame_child && k < links.size(); ++k) {
      const auto T = k == most ? std::optional(timed.pose) : links[k].at(timed.stamp);
      T_frame_child = T ? std::optional(*T_frame_child * chain->steps[k].apply(*T)) : std::nullopt;
    }
    if (T_frame_child)
      found.poses.push_back({timed.stamp, *T_frame_child * chain->T_behind});
    else
      ++found.alone;
  }
  return found;
}

}  // namespace radioslam
