#include "radioslam/io/ros/mcap.hpp"

#include <zlib.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "radioslam/base/units.hpp"
#include "radioslam/io/ros/mcap_format.hpp"
#include "radioslam/io/text/byte_cursor.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMcapRecordHeader = 9;
constexpr std::uint64_t kMaxTime_ns = std::uint64_t{1} << 62U;

std::string decompress(const ByteCursor& at, const std::string& place, const std::string& compression,
                       std::string_view packed, std::uint64_t size) {
  if (size > kMaxDecompressed) at.fail("the chunk is implausibly long");
  if (compression.empty()) return std::string(packed);
  if (compression == "lz4") return decompress_lz4(place, packed, static_cast<std::size_t>(size));
  if (compression == "zstd") return decompress_zstd(place, packed, static_cast<std::size_t>(size));
  at.fail("unknown compression '" + compression + "'");
}

/// The records of a chunk.
std::string unpack_chunk(ByteCursor content, const std::string& place) {
  content.take(16);  // times
  const std::uint64_t size = content.u64();
  const std::uint32_t checksum = content.u32();
  const std::string compression(content.counted());
  const std::string_view packed = content.take(content.u64());
  std::string unpacked = decompress(content, place, compression, packed, size);
  if (unpacked.size() != size) content.fail("the chunk's length differs from the stated one");
  if (checksum != 0 && checksum != mcap_checksum(unpacked))
    content.fail("the chunk is corrupt: wrong checksum");
  return unpacked;
}

/// The time that a chunk covers; 0 if it does not say.
std::uint64_t duration_ns(ByteCursor content) {
  if (content.left() < 2 * sizeof(std::uint64_t)) return 0;
  const std::uint64_t begin_ns = content.u64();
  const std::uint64_t end_ns = content.u64();
  return begin_ns <= end_ns && end_ns <= kMaxTime_ns ? end_ns - begin_ns : 0;
}

std::string format_seconds(std::uint64_t ns) {
  std::ostringstream text;
  text << static_cast<double>(ns / kNanosecondsPerMillisecond) * kSecondsPerMillisecond;
  return text.str();
}

/// The recording's channels that are read.
class McapReader {
 public:
  McapReader(const std::string& name, const RosVisitor& visitor) : name_(name), visitor_(visitor) {}

  std::vector<std::string> read(std::string_view bytes) {
    ByteCursor cursor(bytes, ByteOrder::kLittle, {name_});
    cursor.take(kMcapMagic.size());
    read_channels(cursor);
    while (!ended_ && !is_cut_off(cursor)) read_record(cursor);
    if (!ended_) note_end(cursor);
    if (chunks_.count() > 0)
      warnings_.push_back(chunks_.warning(name_, "chunk") +
                          (lost_ns_ == 0 ? "" : "; in all, " + format_seconds(lost_ns_) + " s are lost"));
    if (records_.count() > 0) warnings_.push_back(records_.warning(name_, "record"));
    for (const std::string& encoding : foreign_)
      warnings_.push_back(name_ + ": messages encoded as '" + encoding + "' are left out");
    return std::move(warnings_);
  }

 private:
  /// Whether the data end before the next record does, or have only zeros.
  bool is_cut_off(const ByteCursor& cursor) const {
    if (cursor.left() < kMcapRecordHeader) return true;
    if (ByteCursor rest = cursor; rest.skip_zeros() > 0 && rest.empty()) return true;
    ByteCursor ahead = cursor;
    ahead.u8();
    const std::uint64_t length = ahead.u64();
    return length > ahead.left();
  }

  /// Reads the channels outside of chunks: the summary repeats those of chunks that cannot be read.
  void read_channels(ByteCursor cursor) {
    SkippedRecords noted_later;
    while (!is_cut_off(cursor)) {
      const std::uint8_t opcode = cursor.u8();
      const ByteCursor content = content_of(cursor);
      if (opcode == kMcapSchema) noted_later.attempt([&] { return read_schema(content), true; });
      if (opcode == kMcapChannel) noted_later.attempt([&] { return read_channel(content), true; });
    }
  }

  ByteCursor content_of(ByteCursor& cursor) const {
    const std::uint64_t length = cursor.u64();
    const std::size_t begin = cursor.position();
    return {cursor.take(length), ByteOrder::kLittle, {name_, part_, begin}};
  }

  /// The end of a file that lacks the record which ends its data.
  void note_end(ByteCursor& cursor) {
    const std::string place = name_ + ": at byte " + std::to_string(cursor.position()) + ": the file ";
    const bool is_zero = cursor.skip_zeros() > 0 && cursor.empty();
    warnings_.push_back(place + (is_zero ? "has only zeros from here on" : "is truncated") +
                        "; the data before this are read");
  }

  void read_record(ByteCursor& cursor) {
    if (cursor.skip_zeros() > 0) {  // no record begins with a zero: lost in writing
      records_.attempt([&]() -> bool { cursor.fail("zeros in place of a record"); });
      if (is_cut_off(cursor)) return;
    }
    const std::uint8_t opcode = cursor.u8();
    const ByteCursor content = content_of(cursor);
    if (opcode == kMcapSchema) records_.attempt([&] { return read_schema(content), true; });
    if (opcode == kMcapChannel) records_.attempt([&] { return read_channel(content), true; });
    if (opcode == kMcapMessage) read_message(content);
    if (opcode == kMcapChunk) read_chunk(content);
    if (opcode == kMcapDataEnd) ended_ = true;
  }

  void read_schema(ByteCursor content) {
    const std::uint16_t id = content.u16();
    Schema& schema = schemas_[id];
    schema.type = short_type(content.counted());
    const std::string_view encoding = content.counted();
    const std::string_view text = content.counted();
    schema.definition = encoding == "ros1msg" || encoding == "ros2msg" ? std::string(text) : "";
  }

  void read_channel(ByteCursor content) {
    const std::uint16_t id = content.u16();
    const std::uint16_t schema = content.u16();
    const std::string topic(content.counted());
    const std::string encoding(content.counted());
    const auto known = schemas_.find(schema);
    if (schema != 0 && known == schemas_.end()) content.fail("a channel with an unknown schema");
    std::optional<RosChannel>& channel = channels_[id];
    channel.reset();
    if (encoding != "cdr" && encoding != "ros1") return void(foreign_.insert(encoding));
    const Schema used = known == schemas_.end() ? Schema{} : known->second;
    channel = RosChannel{topic, used.type, encoding == "cdr" ? MessageEncoding::kCdr : MessageEncoding::kRos1,
                         used.definition};
  }

  struct Schema {
    std::string type, definition;
  };
  struct Message {
    const RosChannel* channel;  ///< null if its encoding is not read
    Stamp stamp;
    std::string_view bytes;
  };

  Message parse_message(ByteCursor content) const {
    const auto channel = channels_.find(content.u16());
    if (channel == channels_.end()) content.fail("a message of an unknown channel");
    content.u32();  // sequence
    const std::uint64_t time_ns = content.u64();
    content.u64();  // publish time
    if (time_ns > kMaxTime_ns) content.fail("a message's time is implausible");
    return {
        channel->second ? &*channel->second : nullptr, {static_cast<std::int64_t>(time_ns)}, content.rest()};
  }

  void read_message(const ByteCursor& content) {
    const auto message = records_.attempt([&] { return parse_message(content); });
    if (!message || message->channel == nullptr) return;
    const bool is_read = visitor_.reads(*message->channel);
    visitor_.take({*message->channel, message->stamp, is_read ? message->bytes : std::string_view{}, name_});
  }

  void read_chunk(const ByteCursor& content) {
    const std::string place = "the chunk at byte " + std::to_string(content.position());
    const auto unpacked = chunks_.attempt([&] {
      if (!part_.empty()) content.fail("a chunk within a chunk");
      return unpack_chunk(content, name_ + ": " + place);
    });
    if (!unpacked) {
      lost_ns_ += duration_ns(content);
      return;
    }
    part_ = place;
    ByteCursor records(*unpacked, ByteOrder::kLittle, {name_, part_});
    while (!records.empty() && !is_cut_off(records)) read_record(records);
    if (!records.empty()) records_.attempt([&]() -> bool { records.fail("the chunk ends within a record"); });
    part_.clear();
  }

  const std::string& name_;
  const RosVisitor& visitor_;
  std::string part_;  ///< the chunk being read; empty outside chunks
  bool ended_ = false;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::optional<RosChannel>> channels_;
  std::set<std::string> foreign_;
  SkippedRecords chunks_, records_;
  std::uint64_t lost_ns_ = 0;  ///< that chunks which are left out cover
  std::vector<std::string> warnings_;
};

}  // namespace

std::uint32_t mcap_checksum(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::vector<std::string> visit_mcap(const std::string& name, std::string_view bytes,
                                    const RosVisitor& visitor) {
  return McapReader(name, visitor).read(bytes);
}

}  // namespace radioslam
