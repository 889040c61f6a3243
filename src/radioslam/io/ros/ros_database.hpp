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
/// zstd. Of a damaged database, the messages that can be read are passed on, from the damage on in the order
/// of their ids. Refuses (InputError) a database without these tables, and one without a readable message
/// because of its damage. Returns the warnings.
std::vector<std::string> visit_ros_database(const std::filesystem::path& file, const RosVisitor& visitor);

/// The same of a database in memory.
std::vector<std::string> visit_ros_database(const std::string& name, std::string_view bytes,
                                            const RosVisitor& visitor);

}  // namespace radioslam
