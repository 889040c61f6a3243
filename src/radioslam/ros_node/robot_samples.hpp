// What a robot measures, from messages of ROS 2 as they come (sample_reader.hpp).
//
// Messages are held until it is settled for the whole run which sensors there are, and where: kSettle_s after
// the first odometry or scan, at most kLongestWait_s for topics that the user has stated and kTransformWait_s
// for static transforms to all frames. The body frame is the child of the odometry's first message, else
// base_link or base_footprint.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/ros_node/sample_reader.hpp"

namespace radioslam {

struct RobotSamplesSetup {
  Mission names;  ///< the team as far as it is known: robots, anchors; without recordings
  RobotIndex self;
  std::vector<Antennas> antennas = {};  ///< by robot
  RobotTopics topics = {};
  std::optional<GeodeticPlace> origin = {};  ///< of the frame of position fixes
  bool is_simulated = false;                 ///< its clock is that of a simulation
};

class RobotSamples {
 public:
  static constexpr double kSettle_s = 2, kLongestWait_s = 10, kTransformWait_s = 5;
  static constexpr std::size_t kMostHeldBytes = std::size_t{256} << 20U;

  explicit RobotSamples(RobotSamplesSetup setup);
  RobotSamples(const RobotSamples&) = delete;
  RobotSamples& operator=(const RobotSamples&) = delete;

  void take(RosArrival arrival);
  /// To be called now and then, with the host's time.
  void advance(Stamp now);
  /// With what has come, though it is too early.
  void settle();

  /// What the robot measures its motion by; nothing before that is settled.
  const std::optional<MotionSources>& sources() const { return sources_; }
  /// Grows as others are heard.
  const Mission& names() const { return names_.mission(); }
  RobotIndex self() const { return names_.self(); }
  /// Since the last call, by their stamps as far as they came together.
  std::vector<Sample> take_samples();
  /// What the user should know, in words that follow the robot's name; since the last call.
  std::vector<std::string> take_notes() { return notes_.take(); }

  /// The recorded odometry of the last seconds, in its own frame; nothing without.
  std::optional<SE3> odometry_at(Stamp stamp) const { return reader_.odometry_at(stamp); }
  /// Empty without recorded odometry.
  const std::string& odometry_frame() const { return odometry_frame_; }
  const std::string& body_frame() const { return frames_.body(); }

 private:
  struct TopicState {
    std::string frame, child;  ///< of its first message that can be read
    std::size_t messages = 0;
    bool is_used = false;
  };

  void read(const RosArrival& arrival);
  void take_transforms(const RosArrival& arrival);
  void note_frame(const RosArrival& arrival);
  bool has_come(RobotTopicKind kind) const;
  bool is_settled(Stamp now) const;
  bool are_frames_known() const;
  void choose_topics();
  void place_sensors();
  void describe_scanner();
  void say_what_is_used();

  NotesOnce notes_;
  HeardNames names_;
  RobotTopics topics_;
  std::optional<GeodeticPlace> origin_;
  SensorFrames frames_;
  SampleReader reader_;
  std::vector<TopicState> states_;
  std::deque<RosArrival> held_;
  std::size_t held_bytes_ = 0;
  std::optional<Stamp> first_;  ///< odometry or scan
  std::optional<MotionSources> sources_;
  Stamp settled_, now_;
  std::string odometry_frame_;
  std::vector<Sample> waiting_;
};

}  // namespace radioslam
