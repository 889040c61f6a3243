#include "radioslam/io/ros_body.hpp"

namespace radioslam {
namespace {

constexpr const char* kUsualBody = "base_link";

}  // namespace

std::string body_frame(const RosSurvey& survey, const RosTopicChoice& choice) {
  if (choice.odometry && !choice.odometry->child.empty()) return choice.odometry->child;
  if (choice.odometry)
    if (const RosTopic* topic = survey.find(choice.odometry->topic); !topic->child.empty())
      return topic->child;
  for (const char* usual : {kUsualBody, "base_footprint"})
    if (survey.frames.knows(usual)) return usual;
  return "";
}

SE3 place_of_sensor(const RosSurvey& survey, const std::string& body, const std::string& topic,
                    std::vector<std::string>& warnings) {
  const std::string& sensor = survey.find(topic)->frame;
  if (sensor == body) return {};
  if (!body.empty())
    if (const auto T_body_sensor = survey.frames.find(body, sensor)) return *T_body_sensor;
  if (body.empty() && sensor == kUsualBody) return {};
  warnings.push_back(topic + ": " +
                     (body.empty() ? "nothing names the body's frame"
                                   : "no fixed transform leads from " + body + " to " + sensor) +
                     "; '" + sensor + "' is taken as the body's frame");
  return {};
}

}  // namespace radioslam
