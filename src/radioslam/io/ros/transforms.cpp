#include "radioslam/io/ros/transforms.hpp"

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

constexpr double kSameTransform = 1e-6;  ///< m and rad

}  // namespace

void FrameTree::add(const std::string& parent, const std::string& child, const SE3& T_parent_child) {
  parents_[child] = {parent, T_parent_child};
}

bool FrameTree::knows(const std::string& frame) const {
  return parents_.contains(frame) || std::any_of(parents_.begin(), parents_.end(), [&](const auto& link) {
           return link.second.parent == frame;
         });
}

std::map<std::string, SE3> FrameTree::ancestors_of(const std::string& frame) const {
  std::map<std::string, SE3> ancestors{{frame, SE3()}};
  SE3 T_ancestor_frame;
  for (auto link = parents_.find(frame); link != parents_.end(); link = parents_.find(link->second.parent)) {
    T_ancestor_frame = link->second.T_parent_child * T_ancestor_frame;
    if (!ancestors.emplace(link->second.parent, T_ancestor_frame).second) break;
  }
  return ancestors;
}

std::optional<SE3> FrameTree::find(const std::string& a, const std::string& b) const {
  const auto of_a = ancestors_of(a);
  const auto of_b = ancestors_of(b);
  for (const auto& [frame, T_frame_b] : of_b)
    if (const auto common = of_a.find(frame); common != of_a.end())
      return common->second.inverse() * T_frame_b;
  return std::nullopt;
}

void MovingTransforms::take(const RosMessage& message) {
  for (const RosPose& transform : read_ros_transforms(message)) {
    Link& link = links_[{transform.header.frame, transform.child}];
    if (!transform.pose) {
      ++link.without_pose;
      continue;
    }
    (transform.header.stamp == Stamp{} ? link.timeless : link.poses)
        .push_back({time_of(message, transform.header), *transform.pose});
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
    (link.poses.empty() ? found.without_time : found.left_without_time) += link.timeless.size();
    if (link.used().size() >= chain->steps[most].link->second.used().size()) most = k;
    links.push_back(in_order_of_time(link.used()));
  }
  for (const StampedPose<SE3>& timed : chain->steps[most].link->second.used()) {
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

void FixedTransforms::take(const RosMessage& message) {
  const bool is_static = message.channel.topic.ends_with("tf_static");
  for (RosPose& transform : read_ros_transforms(message)) {
    if (!transform.pose) continue;
    if (is_static) {
      static_.push_back(std::move(transform));
      continue;
    }
    Repeated& pair = repeated_[{transform.header.frame, transform.child}];
    if (pair.times++ == 0) pair.T_parent_child = *transform.pose;
    if (!pair.moves)
      pair.moves = (pair.T_parent_child.inverse() * *transform.pose).log().norm() > kSameTransform;
  }
}

FrameTree FixedTransforms::tree() const {
  FrameTree frames;
  for (const auto& [pair, repeated] : repeated_)
    if (repeated.times > 1 && !repeated.moves) frames.add(pair.first, pair.second, repeated.T_parent_child);
  for (const RosPose& transform : static_)
    frames.add(transform.header.frame, transform.child, *transform.pose);
  return frames;
}

}  // namespace radioslam
