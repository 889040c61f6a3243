// A ROS recording as a mission of one robot.
//
// The body is what the odometry says moves (its child frame), else base_link or base_footprint where a fixed
// transform knows it, else the scans' own frame. Points and inertial readings are brought into it by the
// transforms that never change (fixed_transforms.hpp); where none leads there they are taken as the body's,
// and a warning says so.
// An inertial unit's place off the body's origin is not accounted for.
//
// A message's time is that of its header, or of the recording where the header has none. Messages may come in
// any order; of two of one time the first counts. Odometry begins at the body's first place and heading; its
// tilt is kept. Scans of a plane (LaserScan) make a mission of dimension 2, as does odometry alone that
// climbs less than 0.1 m and tilts less than 5 degrees. Poses out of a topic of transforms go over
// as many moving ones as lie between the frames (moving_transforms.hpp).
//
// Position fixes (NavSatFix) become places east, north and up (local_frame.hpp) of the team's first one, with
// the sigma of their worst axis, 10 m where none is told; where they tell no height they lie as high as the
// first.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/io/imported_mission.hpp"
#include "radioslam/io/ros_scans.hpp"
#include "radioslam/io/ros_topics.hpp"

namespace radioslam {

struct RosImport {
  ImportedMission imported;
  std::size_t scans = 0;
  std::optional<GeodeticPlace> fix_origin;  ///< of the local frame, where there are fixes
};

/// A team's fixes need one `fix_origin`; nothing for the first fix. Goes through the recording twice. Refuses
/// (InputError) what the recording's and the messages' readers and choose_topics refuse, and odometry without
/// a pose.
RosImport import_ros_recording(const std::filesystem::path& source, const std::string& robot,
                               const RosTopicWishes& wishes, const RosScanSink& sink,
                               const std::optional<GeodeticPlace>& fix_origin = std::nullopt);

}  // namespace radioslam
