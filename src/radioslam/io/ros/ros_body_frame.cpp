#include "radioslam/io/ros/ros_body_frame.hpp"

namespace radioslam {
namespace {

constexpr const char* kNominalBody = "base_link";

}  // namespace

std::string body_frame(const RosTopicIndex& survey, const RosTopicChoice& choice) {
  if (choice.odometry && !choice.odometry->child.empty()) return choice.odometry->child;
  if (choice.odometry)
    if (const RosTopic* topic = survey.find(choice.odometry->topic); !topic->child.empty())
      return topic->child;
  for (const char* candidate : {kNominalBody, "base_footprint"})
    if (survey.frames.knows(candidate)) return candidate;
  return "";
}

SE3 extrinsics_of(const RosTopicIndex& survey, const std::string& body, const std::string& topic,
                  std::vector<std::string>& warnings) {
  const std::string& sensor = survey.find(topic)->frame;
  if (sensor == body) return {};
  if (!body.empty())
    if (const auto T_body_sensor = survey.frames.find(body, sensor)) return *T_body_sensor;
  if (body.empty() && sensor == kNominalBody) return {};
  warnings.push_back(topic + ": " +
                     (body.empty() ? "the body frame is unknown"
                                   : "no static transform connects " + body + " with " + sensor) +
                     "; '" + sensor + "' is assumed to be the body frame");
  return {};
}

}  // namespace radioslam
