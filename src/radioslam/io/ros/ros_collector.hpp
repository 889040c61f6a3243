// Collects the measurements of the chosen topics of a ROS recording, transformed to the body frame.
//
// Points: p_body = T_body_sensor p_sensor; IMU samples: v_body = R_body_sensor v_sensor; extrinsics from
// ros_import.hpp. Messages that are left out or changed are counted per topic: repeated stamps, missing
// stamps, invalid poses and samples. Scans are passed on immediately, everything else is kept in memory.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/io/ros/ros_topics.hpp"
#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/io/ros/transforms.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

// Reads the laser scans of one topic of a ROS recording; the unit of the points' times is determined from the
// first messages (point_times.hpp).

/// Receives the scans one by one, in any order, with unique stamps, so that they need not fit into memory.
using RosScanSink = std::function<void(Stamp, const LidarScan&)>;

/// Passes the scans on in the order of their messages; the first ten are held back until the tenth or
/// finish().
class RosScans {
 public:
  using Take = std::function<void(const RosMessage&, RosScan)>;

  explicit RosScans(Take take) : take_(std::move(take)) {}

  /// Adds a message of a scan type; all must be of one channel. Refuses whatever read_ros_scan refuses.
  void take(const RosMessage& message);
  void finish();

  /// Notes for the user on the points' times, one line each.
  std::vector<std::string> notes() const;

 private:
  struct Held {
    RosChannel channel;
    Stamp stamp;
    std::string bytes, file;

    RosMessage message() const { return {channel, stamp, bytes, file}; }
  };

  void find_unit();
  void hand_on(const RosMessage& message);

  Take take_;
  std::vector<Held> held_;
  bool has_unit_ = false;
  std::optional<PointTimeUnit> unit_;
  std::optional<std::string> unit_note_;  ///< note if the unit is not the nominal one
  std::map<PointClock, std::size_t> clocks_;
  std::string topic_;
};

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

  /// Adds a message. Refuses (InputError) whatever the reader of its type refuses.
  void take(const RosMessage& message);

  /// Call once, after the last message.
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
