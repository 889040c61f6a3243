// Imports a ROS recording as a mission of one robot.
//
// The body frame is the child frame of the odometry, otherwise base_link or base_footprint if a static
// transform names it, otherwise the frame of the scans. Points and IMU samples are transformed to it by
// static transforms (transforms.hpp); a sensor without such a transform is assumed to be at the body's
// origin, with a warning. The IMU's lever arm is not taken into account.
//
// A message's time is that of its header. Where no message of a topic has a stamp, it is the recording time,
// less the delay between the two that other topics have if that is more than a second; where some have one,
// those without are left out. Messages may come in any order; of several with the same stamp the first is
// used. Odometry begins at the origin with yaw zero;
// its initial roll and pitch are kept. Planar scans (LaserScan) make a mission of dimension 2, as does
// odometry without scans that climbs less than 0.1 m and tilts less than 5 degrees. Poses from a topic of
// transforms follow the chain of moving transforms between the two frames (transforms.hpp).
//
// Position fixes (NavSatFix) become positions east, north and up of the team's first fix within 100 km of the
// median of all its fixes (local_frame.hpp), with the sigma of their worst axis, or 10 m if none is stated. A
// fix without altitude gets that of the origin; those more than 1000 km off are left out, with a warning.//
// Messages of WiFi drivers (wifi_message.hpp) become the robot's scans, those of one message one scan.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/ros/ros_collector.hpp"
#include "radioslam/io/ros/ros_topics.hpp"

namespace radioslam {

struct RosImport {
  ImportedMission imported;  ///< of one robot, without its position fixes and WiFi scans
  std::size_t scans = 0;
  std::vector<GeodeticFix> fixes;
  WifiLog wifi;
  RosTopicIndex index;           ///< of the recording
  std::set<std::string> topics;  ///< that were read
};

/// Reads the recording twice. Refuses (InputError) whatever the readers of the recording and its messages and
/// choose_topics refuse, and odometry without any pose.
RosImport import_ros_recording(const std::filesystem::path& source, const std::string& robot,
                               const RosTopicRequest& wishes, const RosScanSink& sink);

/// Moves the robots' fixes into their missions, in one local frame for the team.
void place_fixes(std::vector<RosImport>& team);

}  // namespace radioslam
