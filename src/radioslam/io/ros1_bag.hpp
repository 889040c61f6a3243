// ROS 1 bags of version 2.0 (wiki.ros.org/Bags/Format/2.0): a line, then records of u32 length, header fields
// (u32 length, NAME=VALUE), u32 length and data, little endian. Read from front to back, without the index.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/ros_recording.hpp"

namespace radioslam {

inline constexpr std::string_view kRos1BagMagic = "#ROSBAG V2.0\n";

/// Hands the messages to the visitor; chunks may be compressed with bz2 or lz4. Refuses (InputError, with the
/// byte) records that contradict themselves, chunks that cannot be decompressed, messages of an unknown
/// connection, and encrypted bags. A file that is cut off is read as far as it goes, with a warning.
std::vector<std::string> visit_ros1_bag(const std::string& name, std::string_view bytes,
                                        const RosVisitor& visitor);

}  // namespace radioslam
