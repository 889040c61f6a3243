// Collects the measurements of the chosen topics of a ROS recording, transformed to the body frame.
//
// Points: p_body = T_body_sensor p_sensor; IMU samples: v_body = R_body_sensor v_sensor; extrinsics from
// ros_import.hpp. Messages that are left out or changed are counted per topic: repeated stamps, missing
// stamps, invalid poses and samples, and whatever the reader of their type refuses. Scans are passed on
// immediately, everything else is kept in memory.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/io/ros/ros_scans.hpp"
#include "radioslam/io/ros/ros_topics.hpp"
#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/io/ros/transforms.hpp"
#include "radioslam/io/ros/wifi_message.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Numbers of messages left out or changed, by reason.
using RosCounts = std::map<std::string, std::size_t>;

struct GeodeticFix {
  Stamp stamp;
  GeodeticPlace place;
  double sigma_m = 0;
};

/// Everything except the scans' points, sorted by time, with unique stamps.
struct RosCollected {
  std::vector<StampedPose<SE3>> odometry, truth;
  std::vector<ImuSample> inertial;
  std::vector<GeodeticFix> fixes;
  std::vector<WifiRow> wifi;  ///< in the order of the messages
  Eigen::Vector3d fix_lever_m = Eigen::Vector3d::Zero();
  std::set<Stamp> scans;
  bool is_plane_scanner = false;
  double range_max_m = 0;  ///< of a planar scanner; 0 if not stated
  RosCounts counts;
  std::vector<std::string> warnings;
};

class RosCollector {
 public:
  /// `survey` and `sink` must outlive this object.
  RosCollector(const RosTopicIndex& survey, RosTopicChoice choice, const RosScanSink& sink);
  RosCollector(const RosCollector&) = delete;
  RosCollector& operator=(const RosCollector&) = delete;

  bool reads(const RosChannel& channel) const;

  /// Adds a message; one that cannot be read is counted and left out.
  void take(const RosMessage& message);

  /// Call once, after the last message. Refuses (InputError) a topic none of whose messages can be read.
  RosCollected finish();

 private:
  void count(const std::string& topic, const char* what, std::size_t number);
  bool is_timed(const RosMessage& message);
  void take_small(const RosMessage& message);
  void take_pose(const RosMessage& message, std::vector<StampedPose<SE3>>& poses);
  void finish_poses(const RosPoseTopic& topic, std::vector<StampedPose<SE3>>& poses);
  void take_scan(Stamp stamp, RosScan& scan);
  void take_fix(const RosMessage& message);
  void take_inertial(const RosMessage& message);
  void take_wifi(const RosMessage& message);

  const RosTopicIndex& survey_;
  RosTopicChoice choice_;
  const RosScanSink& sink_;
  RosScans scan_messages_;
  std::map<std::string, MovingTransforms> transforms_;  ///< by topic
  std::map<std::string, SkippedRecords> unreadable_;    ///< by topic, all but scans
  std::map<std::string, std::size_t> readable_;         ///< by topic
  std::optional<RosDefinition> wifi_definition_;
  SE3 T_body_laser_, T_body_imu_;
  RosCollected collected_;
};

}  // namespace radioslam
