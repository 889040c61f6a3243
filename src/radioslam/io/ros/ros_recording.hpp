// Reads the messages of a ROS recording: a ROS 1 bag (.bag), an MCAP file (.mcap), a rosbag2 database (.db3),
// or a folder of such files, which together form one recording.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Encoding of a message's bytes.
enum class MessageEncoding {
  kRos1,  ///< ROS 1 serialisation: little endian, unaligned
  kCdr,   ///< OMG's Common Data Representation: an encapsulation header, then aligned values
};

/// The channel of a message: topic, type and encoding.
struct RosChannel {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Imu", for ROS 2 as well
  MessageEncoding encoding = MessageEncoding::kCdr;
};

struct RosMessage {
  const RosChannel& channel;
  Stamp stamp;             ///< recording time
  std::string_view bytes;  ///< empty if the visitor does not read them
  std::string_view file;   ///< file that contains the message
};

/// Callbacks for the messages of a recording.
struct RosVisitor {
  /// Whether the bytes of a channel's messages are needed; fetching them takes time.
  std::function<bool(const RosChannel&)> reads;
  std::function<void(const RosMessage&)> take;
};

/// "sensor_msgs/Imu" of "sensor_msgs/msg/Imu".
std::string short_type(std::string_view type);

/// Passes the messages of all files to the visitor, file by file in the order of the file. Returns warnings
/// for the user (such as a truncated file), one line each. Refuses (InputError) a source that is not a
/// recording.
std::vector<std::string> visit_recording(const std::filesystem::path& source, const RosVisitor& visitor);

}  // namespace radioslam
