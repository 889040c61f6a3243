#include "radioslam/ros_node/sensor_frames.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostLinks = 1000;  // the tree is searched link by link
constexpr const char* kNominalBodies[] = {"base_link", "base_footprint"};

}  // namespace

void SensorFrames::take(const RosMessage& message) {
  for (const RosPose& transform : read_ros_transforms(message)) {
    if (!transform.pose || transform.header.frame.empty() || transform.child.empty()) continue;
    if (++links_ > kMostLinks) return;
    frames_.add(transform.header.frame, transform.child, *transform.pose);
  }
}

void SensorFrames::find_body(const std::string& child, const std::string& robot) {
  body_ = child;
  for (const char* nominal : kNominalBodies)
    for (const std::string& name : {std::string(nominal), robot + '/' + nominal})
      if (body_.empty() && frames_.knows(name)) body_ = name;
}

std::optional<SE3> SensorFrames::find(const std::string& frame) const {
  if (frame.empty() || frame == body_ || (body_.empty() && frame == kNominalBodies[0])) return SE3();
  return body_.empty() ? std::nullopt : frames_.find(body_, frame);
}

SE3 SensorFrames::pose_of(const std::string& topic, const std::string& frame, NotesOnce& notes) const {
  if (const auto T_body_sensor = find(frame)) return *T_body_sensor;
  const std::string why =
      body_.empty()
          ? "the body frame is unknown, as odometry or a static transform from base_link would state"
          : "no static transform connects " + body_ + " with '" + frame + "'";
  notes.say("topic " + topic + ": " + why + "; the sensor is assumed at the body's origin. Is /tf_static " +
            "published, by the robot's robot_state_publisher or static_transform_publisher?");
  return {};
}

}  // namespace radioslam
