// Reads the messages of a ROS recording: a ROS 1 bag (.bag), an MCAP file (.mcap), a rosbag2 database (.db3),
// or a folder of such files, which together form one recording. Files compressed with Zstandard (.zstd, .zst)
// are decompressed in memory, at most 8 GiB each.
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
  std::string definition = {};  ///< text of the type's definition; empty if the recording lacks it
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
/// for the user, one line each: damage, files that cannot be read, parts that metadata.yaml names and that
/// are not there, and files of the folder that may be parts. Refuses (InputError) a source without a readable
/// recording.
std::vector<std::string> visit_recording(const std::filesystem::path& source, const RosVisitor& visitor);

/// The recordings of a source, sorted: itself, or those of a folder and the folders below it. The files of a
/// folder are one recording if it has a metadata.yaml, or if their names differ in numbers alone and they do
/// not overlap in time by more than a second, but for copies of the same messages; else each of them is one.
std::vector<std::filesystem::path> recordings_in(const std::filesystem::path& source);

/// The name of a file or folder without the extensions of its format: drive of drive.db3.zstd and of drive/.
std::string recording_name(const std::filesystem::path& source);

}  // namespace radioslam
