// What the chosen topics of a ROS recording say, message by message, brought into the body's frame.
//
// Points: p_body = T_body_sensor p_sensor; inertial readings: v_body = R_body_sensor v_sensor; both from
// ros_body.hpp. What is left out or replaced is counted per topic: messages of a time that another has,
// messages without a time of their own, poses and readings that are none. Scans are handed on as they come,
// everything else is kept.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/io/moving_transforms.hpp"
#include "radioslam/io/ros_scans.hpp"
#include "radioslam/io/ros_topics.hpp"
#include "radioslam/mission/inertial.hpp"

namespace radioslam {

/// What is left out or replaced, by why.
using RosCounts = std::map<std::string, std::size_t>;

struct GeodeticFix {
  Stamp stamp;
  GeodeticPlace place;
  double sigma_m = 0;
};

/// Everything but the scans' points, in the order of time, each stamp once.
struct RosCollected {
  std::vector<StampedPose<SE3>> odometry, truth;
  std::vector<InertialSample> inertial;
  std::vector<GeodeticFix> fixes;
  Eigen::Vector3d fix_lever_m = Eigen::Vector3d::Zero();
  std::set<Stamp> scans;
  bool is_plane_scanner = false;
  double range_max_m = 0;  ///< of the plane's scanner; 0 where not told
  RosCounts counts;
  std::vector<std::string> warnings;
};

class RosCollector {
 public:
  /// `survey` and `sink` must outlive this.
  RosCollector(const RosSurvey& survey, RosTopicChoice choice, const RosScanSink& sink);
  RosCollector(const RosCollector&) = delete;
  RosCollector& operator=(const RosCollector&) = delete;

  bool reads(const RosChannel& channel) const;

  /// Refuses what the messages' readers refuse.
  void take(const RosMessage& message);

  /// Behind the last message, once.
  RosCollected finish();

 private:
  void count(const std::string& topic, const char* what, std::size_t number);
  Stamp counted_time_of(const RosMessage& message, const RosHeader& header);
  void take_pose(const RosMessage& message, std::vector<StampedPose<SE3>>& poses);
  void finish_poses(const RosPoseTopic& topic, std::vector<StampedPose<SE3>>& poses);
  void take_scan(const RosMessage& message, RosScan& scan);
  void take_fix(const RosMessage& message);
  void take_inertial(const RosMessage& message);

  const FrameTree& frames_;
  RosTopicChoice choice_;
  const RosScanSink& sink_;
  RosScans scan_messages_;
  std::map<std::string, MovingTransforms> transforms_;  ///< by topic
  SE3 T_body_laser_, T_body_imu_;
  RosCollected collected_;
};

}  // namespace radioslam
