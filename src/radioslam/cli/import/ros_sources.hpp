// The sources of `radioslam import rosbag`, one robot each: recordings, their robots' names and their topics.
#pragma once

#include <string>
#include <vector>

#include "radioslam/cli/import/import_options.hpp"
#include "radioslam/io/ros/ros_ranges.hpp"
#include "radioslam/io/ros/ros_topics.hpp"

namespace radioslam::cli {

/// One robot of the team.
struct RosSource {
  std::string recording;
  std::string robot;
  RosTopicRequest topics;
};

/// Folders become the recordings in them. A single recording is the source of as many robots as --robot or a
/// topic is given times. Without --robot, several robots are named after their recordings, or after what
/// differs in their odometry topics where the recording is the same; a single one is a. Refuses (InputError)
/// numbers that do not agree, invalid names and names that occur twice.
std::vector<RosSource> ros_sources(const ImportOptions& options);

/// Whose ranges to read: --ranges TOPIC=ID,ID and --name RADIO=ID. Refuses (InputError) other forms.
RosRangeRequest ros_range_request(const ImportOptions& options, const std::vector<RosSource>& sources);

}  // namespace radioslam::cli
