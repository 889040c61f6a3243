#include "radioslam/io/ros/mcap.hpp"

#include <zlib.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "radioslam/io/text/byte_cursor.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam {
namespace {

enum McapOpcode : std::uint8_t {
  kMcapSchema = 0x03,
  kMcapChannel = 0x04,
  kMcapMessage = 0x05,
  kMcapChunk = 0x06,
  kMcapDataEnd = 0x0f,
};
constexpr std::size_t kMcapRecordHeader = 9;
constexpr std::uint64_t kMaxTime_ns = std::uint64_t{1} << 62U;

/// The recording's channels that are read.
class McapReader {
 public:
  McapReader(const std::string& name, const RosVisitor& visitor) : name_(name), visitor_(visitor) {}

  std::vector<std::string> read(std::string_view bytes) {
    ByteCursor cursor(bytes, ByteOrder::kLittle, {name_});
    cursor.take(kMcapMagic.size());
    while (!ended_ && !is_cut_off(cursor)) read_record(cursor);
    if (!ended_)
      warnings_.push_back(name_ + ": at byte " + std::to_string(cursor.position()) +
                          ": the file is truncated; the data before this are read");
    for (const std::string& encoding : foreign_)
      warnings_.push_back(name_ + ": messages encoded as '" + encoding + "' are left out");
    return std::move(warnings_);
  }

 private:
  /// Whether the file ends before the next record does.
  bool is_cut_off(const ByteCursor& cursor) const {
    if (cursor.left() < kMcapRecordHeader) return true;
    ByteCursor ahead = cursor;
    ahead.u8();
    const std::uint64_t length = ahead.u64();
    return length > ahead.left();
  }

  void read_record(ByteCursor& cursor) {
    const std::uint8_t opcode = cursor.u8();
    const std::uint64_t length = cursor.u64();
    const std::size_t begin = cursor.position();
    const ByteCursor content(cursor.take(length), ByteOrder::kLittle, {name_, part_, begin});
    switch (opcode) {
      case kMcapSchema:
        return read_schema(content);
      case kMcapChannel:
        return read_channel(content);
      case kMcapMessage:
        return read_message(content);
      case kMcapChunk:
        return read_chunk(content);
      case kMcapDataEnd:
        ended_ = true;
        return;
      default:
        return;
    }
  }

  void read_schema(ByteCursor content) {
    const std::uint16_t id = content.u16();
    types_[id] = short_type(content.counted());
  }

  void read_channel(ByteCursor content) {
    const std::uint16_t id = content.u16();
    const std::uint16_t schema = content.u16();
    const std::string topic(content.counted());
    const std::string encoding(content.counted());
    const auto type = types_.find(schema);
    if (schema != 0 && type == types_.end()) content.fail("a channel with an unknown schema");
    std::optional<RosChannel>& channel = channels_[id];
    channel.reset();
    if (encoding != "cdr" && encoding != "ros1") return void(foreign_.insert(encoding));
    channel = RosChannel{topic, type == types_.end() ? "" : type->second,
                         encoding == "cdr" ? MessageEncoding::kCdr : MessageEncoding::kRos1};
  }

  void read_message(ByteCursor content) {
    const auto channel = channels_.find(content.u16());
    if (channel == channels_.end()) content.fail("a message of an unknown channel");
    content.u32();  // sequence
    const std::uint64_t time_ns = content.u64();
    content.u64();  // publish time
    if (time_ns > kMaxTime_ns) content.fail("a message's time is implausible");
    if (!channel->second) return;
    const bool is_read = visitor_.reads(*channel->second);
    visitor_.take({*channel->second,
                   {static_cast<std::int64_t>(time_ns)},
                   is_read ? content.rest() : std::string_view{},
                   name_});
  }

  void read_chunk(ByteCursor content) {
    if (!part_.empty()) content.fail("a chunk within a chunk");
    const std::string place = "the chunk at byte " + std::to_string(content.position());
    content.take(16);  // times
    const std::uint64_t size = content.u64();
    const std::uint32_t checksum = content.u32();
    const std::string compression(content.counted());
    const std::string_view packed = content.take(content.u64());
    const std::string unpacked = unpack_chunk(content, compression, packed, size);
    if (unpacked.size() != size) content.fail("the chunk's length differs from the stated one");
    if (checksum != 0 && checksum != checksum_of(unpacked))
      content.fail("the chunk is corrupt: wrong checksum");
    part_ = place;
    ByteCursor records(unpacked, ByteOrder::kLittle, {name_, part_});
    while (!records.empty()) read_record(records);
    part_.clear();
  }

  std::string unpack_chunk(const ByteCursor& at, const std::string& compression, std::string_view packed,
                           std::uint64_t size) const {
    if (size > kMaxDecompressed) at.fail("the chunk is implausibly long");
    const std::string place = name_ + ": the chunk at byte " + std::to_string(at.position());
    if (compression.empty()) return std::string(packed);
    if (compression == "lz4") return decompress_lz4(place, packed, static_cast<std::size_t>(size));
    if (compression == "zstd") return decompress_zstd(place, packed, static_cast<std::size_t>(size));
    at.fail("unknown compression '" + compression + "'");
  }

  static std::uint32_t checksum_of(const std::string& bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  }

  const std::string& name_;
  const RosVisitor& visitor_;
  std::string part_;  ///< the chunk being read; empty outside chunks
  bool ended_ = false;
  std::map<std::uint16_t, std::string> types_;
  std::map<std::uint16_t, std::optional<RosChannel>> channels_;
  std::set<std::string> foreign_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> visit_mcap(const std::string& name, std::string_view bytes,
                                    const RosVisitor& visitor) {
  return McapReader(name, visitor).read(bytes);
}

}  // namespace radioslam
