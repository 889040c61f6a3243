// Where a robot's sensors are: its body frame, and the static transforms to theirs.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>

#include "radioslam/io/ros/transforms.hpp"
#include "radioslam/ros_node/notes_once.hpp"

namespace radioslam {

class SensorFrames {
 public:
  /// A message of static transforms.
  void take(const RosMessage& message);

  /// `child`: that of the odometry; empty without one. `robot`: its name, which prefixes frames.
  void find_body(const std::string& child, const std::string& robot);
  const std::string& body() const { return body_; }
  bool knows(const std::string& frame) const { return find(frame).has_value(); }

  /// T_body_sensor. Where nothing connects the frames, the sensor is assumed at the body's origin, which is
  /// said.
  SE3 pose_of(const std::string& topic, const std::string& frame, NotesOnce& notes) const;

 private:
  std::optional<SE3> find(const std::string& frame) const;

  FrameTree frames_;
  std::size_t links_ = 0;
  std::string body_;
};

}  // namespace radioslam
