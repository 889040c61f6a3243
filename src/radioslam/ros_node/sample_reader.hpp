// Messages of ROS 2 as samples for the front end, of any bytes: whatever it would abort at is left out here.
//
// Points, forces and directions are turned into the body frame; odometry starts at its first position and
// yaw; fixes are east, north and up of an origin. As `radioslam import` reads recordings
// (io/ros/ros_import.hpp), message by message. Left out, and said once a topic with the likely cause: what
// cannot be read, is not finite or not possible, and stamps that are refused (stamp_gate.hpp).
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/front_end/front_end.hpp"
#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/io/ros/ros_scans.hpp"
#include "radioslam/ros_node/heard_names.hpp"
#include "radioslam/ros_node/robot_topics.hpp"
#include "radioslam/ros_node/ros_arrival.hpp"
#include "radioslam/ros_node/sensor_frames.hpp"
#include "radioslam/ros_node/stamp_gate.hpp"

namespace radioslam {

class SampleReader {
 public:
  static constexpr std::size_t kMostMessageBytes = std::size_t{32} << 20U, kMostPoints = 2'000'000;

  /// Keeps references.
  SampleReader(HeardNames& names, const SensorFrames& frames, const std::optional<GeodeticPlace>& origin,
               bool is_simulated, NotesOnce& notes);
  SampleReader(const SampleReader&) = delete;
  SampleReader& operator=(const SampleReader&) = delete;

  /// Where the topic's sensor is, before its first message.
  void place(const std::string& topic, const SE3& T_body_sensor) { places_[topic] = T_body_sensor; }
  void read(const RobotTopic& topic, const RosArrival& arrival);
  /// Since the last call.
  std::vector<Sample> take() { return std::exchange(samples_, {}); }
  /// Whether scans come out as they come in; the first ten wait for each other.
  bool hands_scans_on() const { return scans_.has_begun(); }

  /// The recorded odometry of the last seconds, in its own frame.
  std::optional<SE3> odometry_at(Stamp stamp) const;

 private:
  void read_timed(const RobotTopic& topic, const RosArrival& arrival);
  void read_odometry(const RobotTopic& topic, const RosMessage& message);
  void read_imu(const RobotTopic& topic, const RosMessage& message);
  void read_fix(const RobotTopic& topic, const RosMessage& message);
  void read_ranges(const RobotTopic& topic, const RosMessage& message);
  void read_range_to(const RobotTopic& topic, const RosMessage& message);
  void read_angles(const RobotTopic& topic, const RosMessage& message);
  void read_wifi(const RobotTopic& topic, const RosMessage& message);
  void take_scan(Stamp stamp, RosScan& scan);
  void add_range(const RobotTopic& topic, RangeMeasurement range, const std::string& other,
                 const std::string& other_antenna);
  SE3 place_of(const std::string& topic) const;
  const SE3& place_of(const std::string& topic, const std::string& frame);
  void leave_out(const RobotTopic& topic, const std::string& what, const std::string& detail = {});

  HeardNames& names_;
  const SensorFrames& frames_;
  const std::optional<GeodeticPlace>& origin_;
  NotesOnce& notes_;
  StampGate gate_;
  std::map<std::string, SE3> places_;                                ///< T_body_sensor, by topic
  std::map<std::pair<std::string, std::string>, SE3> frame_places_;  ///< by topic and frame
  RosScans scans_;
  RobotTopic scan_topic_;
  bool is_planar_ = false;
  std::optional<SE3> T_start_odometry_;
  std::deque<StampedPose<SE3>> odometry_;
  std::vector<Sample> samples_;
};

}  // namespace radioslam
