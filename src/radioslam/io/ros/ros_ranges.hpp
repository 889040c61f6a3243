// Reads the ranges between radios (UWB) in a ROS recording: topics of sensor_msgs/Range, and of UWB drivers
// whose messages say between which radios they are (uwb_message.hpp).
//
// A Range does not say between whom it was measured. The two ends are those the user states for the topic, or
// the two robots or radios whose names occur in the topic's name or frame: as parts between slashes, or else
// as words of those. Where only one occurs, the other end is the robot that made the recording. A topic
// without two ends is left out, with a note: it may be a sonar's.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/ros/ros_topics.hpp"

namespace radioslam {

/// Sigma of a range whose message states none.
inline constexpr double kUnknownRangeSigma_m = 0.1;

struct RosRange {
  Stamp stamp;
  std::string i, j;  ///< names of robots or anchors
  double range_m = 0, sigma_m = 0;
};

struct RosRangeRequest {
  std::map<std::string, std::pair<std::string, std::string>> ends;  ///< by topic
  std::map<std::string, std::string> names;                         ///< robot or anchor of a radio
  std::set<std::string> robots;                                     ///< all of the team
  std::string own;  ///< the robot that made the recording; empty if several are in it
};

struct RosRanges {
  std::vector<RosRange> ranges;  ///< in time order
  std::set<std::string> topics;  ///< that were read
  std::vector<std::string> warnings;
};

/// Whether messages of the topic may have ranges between radios.
bool may_have_ranges(const RosTopic& topic);

/// Reads the recording once if it has such topics. Ranges that are not positive, not finite or outside of the
/// limits that they state are left out and counted, as are messages that cannot be read.
RosRanges read_ros_ranges(const std::filesystem::path& source, const RosTopicIndex& index,
                          const RosRangeRequest& request);

}  // namespace radioslam
