// Recordings of ROS, as messages one after the other: a ROS 1 bag (.bag), an MCAP file (.mcap), a rosbag2
// database (.db3), or a folder with such files, which then are one recording.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// How a message's bytes are laid out.
enum class MessageEncoding {
  kRos1,  ///< little endian, nothing aligned
  kCdr,   ///< OMG's Common Data Representation: an encapsulation header, then aligned values
};

/// What a message belongs to.
struct RosChannel {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Imu", in ROS 2 as well
  MessageEncoding encoding = MessageEncoding::kCdr;
};

struct RosMessage {
  const RosChannel& channel;
  Stamp stamp;             ///< when it was recorded
  std::string_view bytes;  ///< empty where the visitor does not read them
  std::string_view file;   ///< in which it stands
};

/// Who is told about a recording's messages.
struct RosVisitor {
  /// Whether the bytes of a channel's messages are to be read: fetching them costs.
  std::function<bool(const RosChannel&)> reads;
  std::function<void(const RosMessage&)> take;
};

/// "sensor_msgs/Imu" of "sensor_msgs/msg/Imu".
std::string short_type(std::string_view type);

/// Hands the messages of all files to the visitor, file by file as they stand there, and returns what a user
/// should know (a file that ends early), one line each. Refuses (InputError) what is no recording.
std::vector<std::string> visit_recording(const std::filesystem::path& source, const RosVisitor& visitor);

}  // namespace radioslam
