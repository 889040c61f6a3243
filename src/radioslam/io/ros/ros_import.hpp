// Imports a ROS recording as a mission of one robot.
//
// The body frame is the child frame of the odometry, otherwise base_link or base_footprint if a static
// transform names it, otherwise the frame of the scans. Points and IMU samples are transformed to it by
// static transforms (transforms.hpp); a sensor without such a transform is assumed to be at the body's
// origin, with a warning. The IMU's lever arm is not taken into account.
//
// A message's time is that of its header, or the recording time if the header has none. Messages may come in
// any order; of several with the same stamp the first is used. Odometry begins at the origin with yaw zero;
// its initial roll and pitch are kept. Planar scans (LaserScan) make a mission of dimension 2, as does
// odometry without scans that climbs less than 0.1 m and tilts less than 5 degrees. Poses from a topic of
// transforms follow the chain of moving transforms between the two frames (transforms.hpp).
//
// Position fixes (NavSatFix) become positions east, north and up of the team's first fix (local_frame.hpp),
// with the sigma of their worst axis, or 10 m if none is stated. A fix without altitude gets that of the
// first fix.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/ros/ros_collector.hpp"
#include "radioslam/io/ros/ros_topics.hpp"

namespace radioslam {

struct RosImport {
  ImportedMission imported;
  std::size_t scans = 0;
  std::optional<GeodeticPlace> fix_origin;  ///< of the local frame, if there are fixes
};

/// All robots of a team need the same `fix_origin`; without one, the first fix is used. Reads the recording
/// twice. Refuses (InputError) whatever the readers of the recording and its messages and choose_topics
/// refuse, and odometry without any pose.
RosImport import_ros_recording(const std::filesystem::path& source, const std::string& robot,
                               const RosTopicRequest& wishes, const RosScanSink& sink,
                               const std::optional<GeodeticPlace>& fix_origin = std::nullopt);

}  // namespace radioslam
