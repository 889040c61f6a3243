// Topics of ROS 2 from which a robot gets what it measures, and how a command line states them:
//   scans=/lidar/points   scans come from there
//   imu=none              from nowhere
//   range:b=uwb/to_b      sensor_msgs/Range, which does not say to whom: to robot or anchor b
// Names that do not begin with '/' are relative to the robot's namespace. Where nothing is stated, each kind
// has names that robots have by convention.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace radioslam {

enum class RobotTopicKind { kOdometry, kScans, kImu, kFix, kRanges, kAngles, kWifi, kCsi, kRangeTo };

struct RobotTopic {
  RobotTopicKind kind = RobotTopicKind::kOdometry;
  std::string name;          ///< absolute
  bool is_stated = false;    ///< by the user, who expects it to be there
  std::string partner = {};  ///< of kRangeTo
};

/// In the order in which they are preferred where several of one kind are published.
struct RobotTopics {
  std::string space;  ///< the robot's namespace: "/a", or empty
  std::vector<RobotTopic> measured;
  std::string transforms = "/tf", static_transforms = "/tf_static", clock = "/clock";
};

/// "odometry", as command lines have it.
std::string name_of(RobotTopicKind kind);
/// Kinds that may be stated, for help and messages.
std::string list_of_topic_kinds();
/// Types that are read, preferred ones first: "nav_msgs/Odometry", ...
const std::vector<std::string_view>& types_of(RobotTopicKind kind);

/// Throws InputError for what is no KIND=NAME, a kind that is stated twice, and names that ROS does not have.
RobotTopics robot_topics(const std::string& space, const std::vector<std::string>& stated);

}  // namespace radioslam
