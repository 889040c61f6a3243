// Writes an MCAP file (mcap.dev/spec) of ROS 2 messages: profile ros2, definitions as ros2msg, messages in
// CDR.
//
// Messages are kept in chunks (zstd, CRC-32, with an index of each channel's messages); the summary repeats
// schemas and channels and has statistics and the chunks' index, so that a player finds any time without
// reading the file. The same messages give the same bytes.
//
// At most kChunkBytes of messages are in memory, and nothing of what came kChunk_s or more before the last
// message: a program that is killed leaves a file beside the target, which readers take as a truncated one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam {

class McapWriter {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;
  static constexpr double kChunk_s = 2;

  /// Refuses what OutputFile refuses.
  explicit McapWriter(const std::filesystem::path& target);

  /// `type`: "nav_msgs/msg/Odometry"; `definition`: its .msg file, followed by those of the types in it as
  /// ROS has them, each behind a line of 80 '=' and one "MSG: std_msgs/Header". A stamp before 1970 is
  /// written as 0.
  void add(const std::string& topic, const std::string& type, const std::string& definition, Stamp stamp,
           std::string_view cdr);

  /// Moves the file to the target; nothing can be added any more.
  void commit();

 private:
  using TimeAndOffset = std::pair<std::uint64_t, std::uint64_t>;
  struct Schema {
    std::string type, definition;
  };
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic;
    std::uint64_t messages = 0;
  };
  struct ChunkIndex {
    std::uint64_t begin_ns = 0, end_ns = 0, start = 0, length = 0;
    std::map<std::uint16_t, std::uint64_t> message_indexes = {};  ///< where, by channel
    std::uint64_t index_length = 0, packed = 0, unpacked = 0;
  };

  std::uint16_t schema_of(const std::string& type, const std::string& definition);
  std::uint16_t channel_of(const std::string& topic, const std::string& type, const std::string& definition);
  std::string schema_record(std::uint16_t id) const;
  std::string channel_record(std::uint16_t id) const;
  static std::string chunk_index_record(const ChunkIndex& index);
  std::string statistics_record() const;
  void write(std::string_view bytes);
  void close_chunk();
  std::string summary() const;

  OutputFile file_;
  std::uint64_t written_ = 0;
  std::uint32_t checksum_ = 0;  ///< of all that is written
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schema_ids_;
  std::map<std::pair<std::string, std::uint16_t>, std::uint16_t> channel_ids_;
  std::string chunk_;  ///< the records of the one that is open
  std::uint64_t chunk_begin_ns_ = 0, chunk_end_ns_ = 0;
  std::map<std::uint16_t, std::vector<TimeAndOffset>> chunk_messages_;
  std::vector<ChunkIndex> chunks_;
};

}  // namespace radioslam
