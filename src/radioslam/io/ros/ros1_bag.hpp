// Reads ROS 1 bags, version 2.0 (wiki.ros.org/Bags/Format/2.0): a line, then records of u32 length, header
// fields (u32 length, NAME=VALUE), u32 length and data (little endian). The file is read sequentially without
// its index.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/ros/ros_recording.hpp"

namespace radioslam {

inline constexpr std::string_view kRos1BagMagic = "#ROSBAG V2.0\n";

/// Passes the messages to the visitor; chunks may be compressed with bz2 or lz4. Inconsistent records, chunks
/// that cannot be decompressed, messages of unknown connections, zeros and all behind a cut are left out.
/// Refuses (InputError) encrypted bags. Returns the warnings: what is left out, and the first of its kind
/// with its byte.
std::vector<std::string> visit_ros1_bag(const std::string& name, std::string_view bytes,
                                        const RosVisitor& visitor);

}  // namespace radioslam
