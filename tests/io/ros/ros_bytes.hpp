// Writes small ROS messages and recordings as bytes; covers only what the tests need of the formats.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {

/// Serialises the values of a message.
class RosBytes {
 public:
  explicit RosBytes(MessageEncoding encoding, ByteOrder order = ByteOrder::kLittle)
      : is_cdr_(encoding == MessageEncoding::kCdr), order_(order) {
    if (is_cdr_)
      bytes_ = std::string("\0", 1) + (order == ByteOrder::kBig ? '\0' : '\1') + std::string(2, '\0');
  }

  RosBytes& u8(unsigned value) { return number(value, 1); }
  RosBytes& u16(std::uint64_t value) { return number(value, 2); }
  RosBytes& u32(std::uint64_t value) { return number(value, 4); }
  RosBytes& u64(std::uint64_t value) { return number(value, 8); }
  RosBytes& f32(float value) { return number(std::bit_cast<std::uint32_t>(value), 4); }
  RosBytes& f64(double value) { return number(std::bit_cast<std::uint64_t>(value), 8); }
  RosBytes& f64s(const std::vector<double>& values) {
    for (const double value : values) f64(value);
    return *this;
  }
  RosBytes& text(const std::string& text) {
    u32(text.size() + (is_cdr_ ? 1 : 0));
    bytes_ += text;
    if (is_cdr_) bytes_ += '\0';
    return *this;
  }
  RosBytes& raw(const std::string& bytes) {
    bytes_ += bytes;
    return *this;
  }
  RosBytes& header(std::uint64_t seconds, std::uint64_t nanoseconds, const std::string& frame) {
    if (!is_cdr_) u32(77);
    return u32(seconds).u32(nanoseconds).text(frame);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  RosBytes& number(std::uint64_t value, std::size_t size) {
    if (is_cdr_)
      while ((bytes_.size() - 4) % size != 0) bytes_ += 'p';
    std::string little;
    append_little_endian(little, value, size);
    bytes_ += order_ == ByteOrder::kLittle ? little : std::string(little.rbegin(), little.rend());
    return *this;
  }

  bool is_cdr_;
  ByteOrder order_;
  std::string bytes_;
};

struct WrittenMessage {
  std::string topic;
  std::string type;  ///< name in ROS 1
  std::int64_t time_ns = 0;
  std::string bytes;
  std::string definition = {};  ///< of the type
};

/// The bytes, preceded by their length as u32.
inline std::string counted(const std::string& bytes) {
  std::string out;
  append_little_endian(out, bytes.size(), 4);
  return out + bytes;
}

inline std::string mcap_record(std::uint8_t opcode, const std::string& content) {
  std::string out(1, static_cast<char>(opcode));
  append_little_endian(out, content.size(), 8);
  return out + content;
}

inline std::string little(std::uint64_t value, std::size_t bytes) {
  std::string out;
  append_little_endian(out, value, bytes);
  return out;
}

/// MCAP records: schemas, channels and messages, each message with its own channel.
inline std::string mcap_records(const std::vector<WrittenMessage>& messages,
                                const std::string& encoding = "cdr") {
  std::string out;
  for (std::size_t k = 0; k < messages.size(); ++k) {
    const WrittenMessage& message = messages[k];
    std::string type = message.type;
    if (encoding == "cdr") type.insert(type.find('/'), "/msg");
    out += mcap_record(0x03,
                       little(k + 1, 2) + counted(type) + counted("ros2msg") + counted(message.definition));
    out += mcap_record(
        0x04, little(k, 2) + little(k + 1, 2) + counted(message.topic) + counted(encoding) + counted(""));
    const auto time = little(static_cast<std::uint64_t>(message.time_ns), 8);
    out += mcap_record(0x05, little(k, 2) + little(0, 4) + time + time + message.bytes);
  }
  return out;
}

inline std::string mcap_chunk(const std::string& records, const std::string& compression,
                              const std::string& packed, std::uint32_t checksum = 0) {
  return mcap_record(0x06, little(0, 16) + little(records.size(), 8) + little(checksum, 4) +
                               counted(compression) + little(packed.size(), 8) + packed);
}

inline const std::string kMcapEnd = mcap_record(0x0f, little(0, 4));

inline std::string mcap_of(const std::string& records) {
  return "\x89MCAP0\r\n" + mcap_record(0x01, counted("ros2") + counted("tests")) + records + kMcapEnd;
}

inline std::string bag_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields) header += counted(field);
  return counted(header) + counted(data);
}

/// Bag records: connections and messages, each message with its own connection.
inline std::string bag_records(const std::vector<WrittenMessage>& messages) {
  std::string out;
  for (std::size_t k = 0; k < messages.size(); ++k) {
    const WrittenMessage& message = messages[k];
    const std::string connection = "conn=" + little(k, 4);
    out += bag_record({"op=\x07", connection, "topic=" + message.topic},
                      counted("topic=" + message.topic) + counted("type=" + message.type) +
                          counted("message_definition=" + message.definition));
    const auto time = little(static_cast<std::uint64_t>(message.time_ns / 1'000'000'000), 4) +
                      little(static_cast<std::uint64_t>(message.time_ns % 1'000'000'000), 4);
    out += bag_record({"op=\x02", connection, "time=" + time}, message.bytes);
  }
  return out;
}

inline std::string bag_chunk(const std::string& records, const std::string& compression,
                             const std::string& packed) {
  return bag_record({"op=\x05", "compression=" + compression, "size=" + little(records.size(), 4)}, packed);
}

inline std::string bag_of(const std::string& records) {
  return "#ROSBAG V2.0\n" + bag_record({"op=\x03", "index_pos=" + little(0, 8)}, std::string(50, ' ')) +
         records;
}

/// A visitor that records "TOPIC TYPE TIME BYTES" for every message.
struct NotedMessages {
  RosVisitor visitor() {
    return {[](const RosChannel& channel) { return channel.topic != "/unread"; },
            [this](const RosMessage& message) {
              lines.push_back(message.channel.topic + ' ' + message.channel.type + ' ' +
                              std::to_string(message.stamp.ns) + ' ' + std::string(message.bytes));
            }};
  }
  std::vector<std::string> lines;
};

/// Two messages, and what NotedMessages records for them.
inline const std::vector<WrittenMessage> kWrittenMessages{{"/a", "std_msgs/String", 1'500'000'001, "hello"},
                                                          {"/unread", "nav_msgs/Odometry", 2, "long"}};
inline const std::vector<std::string> kNotedLines{"/a std_msgs/String 1500000001 hello",
                                                  "/unread nav_msgs/Odometry 2 "};

}  // namespace radioslam
