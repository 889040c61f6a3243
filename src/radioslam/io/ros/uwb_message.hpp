// Ranges in the messages of UWB drivers, which have types of their own: read by the names of their fields.
//
// A message, or each element of a list in it, has a range if it has a field range, distance, dis or dist, and
// one for the other end: to_id, responder_id, destination_id, anchor_id, id2 and the like, or id in a list.
// The end that measured is from_id, requester_id, source_id, tag_id, id1, or id of the message itself;
// without one, it is the robot that recorded it. Whole numbers are millimetres, others metres. Sigma is that
// of a field sigma or std, or the root of a variance or covariance. Such are LinkTrack's node frames
// (nlink_parser), gtec_msgs/Ranging, uwb_ros/RangeStamped and others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/ros/ros_definition.hpp"

namespace radioslam {

struct UwbRange {
  std::string from;  ///< radio; empty if the message does not say
  std::string to;
  double range_m = 0;
  std::optional<double> sigma_m;
};

struct UwbMessage {
  Stamp stamp;  ///< zero if it has none
  std::vector<UwbRange> ranges;
};

/// Whether messages of this definition have ranges.
bool has_uwb_ranges(const RosDefinition& definition);

/// Refuses (InputError) a message that does not fit the definition.
UwbMessage read_uwb_message(const RosDefinition& definition, const RosMessage& message);

}  // namespace radioslam
