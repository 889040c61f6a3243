#include "radioslam/io/ros/fixed_transforms.hpp"

namespace radioslam {
namespace {

constexpr double kSameTransform = 1e-6;  ///< m and rad

}  // namespace

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
