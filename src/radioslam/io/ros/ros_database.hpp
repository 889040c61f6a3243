// Reads rosbag2 databases (.db3): SQLite with the tables
//   topics(id, name, type, serialization_format, ...)  and  messages(id, topic_id, timestamp, data)
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/ros/ros_recording.hpp"

namespace radioslam {

inline constexpr std::string_view kDatabaseMagic{"SQLite format 3\0", 16};

/// Passes the messages to the visitor in the order of their times. Individual messages may be compressed with
/// zstd. Refuses (InputError) a database without these tables and a corrupt one. Returns the warnings.
std::vector<std::string> visit_ros_database(const std::filesystem::path& file, const RosVisitor& visitor);

}  // namespace radioslam
