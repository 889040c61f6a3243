#include "radioslam/io/ros/ros1_bag.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/byte_cursor.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

enum BagOpcode : std::uint8_t {
  kBagMessage = 0x02,
  kBagHeader = 0x03,
  kBagChunk = 0x05,
  kBagConnection = 0x07
};
constexpr std::size_t kLengthBytes = 4;

/// The header of a record or the data of a connection: values by name.
using BagFields = std::map<std::string, std::string_view, std::less<>>;

BagFields read_bag_fields(ByteCursor cursor) {
  BagFields fields;
  while (!cursor.empty()) {
    const std::string_view field = cursor.counted();
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) cursor.fail("a header's field has no '='");
    fields.emplace(field.substr(0, equals), field.substr(equals + 1));
  }
  return fields;
}

/// One record; `data` knows the offset of its data.
struct BagRecord {
  BagFields header;
  ByteCursor data;

  std::string_view field(const char* name) const {
    const auto found = header.find(name);
    if (found == header.end()) data.fail(std::string("a record without ") + name);
    return found->second;
  }
  /// An integer with the given number of bytes, little endian.
  std::uint64_t number(const char* name, std::size_t bytes) const {
    const std::string_view value = field(name);
    if (value.size() != bytes) data.fail(std::string("a record's ") + name + " has a wrong length");
    const ByteView view(value, ByteOrder::kLittle);
    return bytes == 1 ? view.u8(0) : bytes == 4 ? view.u32(0) : view.u64(0);
  }
};

class Ros1BagReader {
 public:
  Ros1BagReader(const std::string& name, const RosVisitor& visitor) : name_(name), visitor_(visitor) {}

  std::vector<std::string> read(std::string_view bytes) {
    ByteCursor cursor(bytes, ByteOrder::kLittle, {name_});
    cursor.take(kRos1BagMagic.size());
    read_connections(cursor);
    while (!cursor.empty() && !is_cut_off(cursor)) read_record(cursor);
    std::vector<std::string> warnings;
    if (!cursor.empty()) {
      const std::string place = name_ + ": at byte " + std::to_string(cursor.position()) + ": the file ";
      const bool is_zero = cursor.skip_zeros() > 0 && cursor.empty();
      warnings.push_back(place + (is_zero ? "has only zeros from here on" : "is truncated") +
                         "; the data before this are read");
    }
    if (chunks_.count() > 0) warnings.push_back(chunks_.warning(name_, "chunk"));
    if (records_.count() > 0) warnings.push_back(records_.warning(name_, "record"));
    return warnings;
  }

 private:
  /// Whether the data end before the next record does, or have only zeros.
  static bool is_cut_off(ByteCursor ahead) {
    if (ByteCursor rest = ahead; rest.skip_zeros() >= 2 * kLengthBytes && rest.empty()) return true;
    for (int part = 0; part < 2; ++part) {
      if (ahead.left() < kLengthBytes) return true;
      const std::uint32_t length = ahead.u32();
      if (length > ahead.left()) return true;
      ahead.take(length);
    }
    return false;
  }

  BagRecord next_record(ByteCursor& cursor) const {
    const std::size_t header_begin = cursor.position() + kLengthBytes;
    const std::string_view header = cursor.counted();
    const std::size_t data_begin = cursor.position() + kLengthBytes;
    const ByteCursor data{cursor.counted(), ByteOrder::kLittle, {name_, part_, data_begin}};
    return {read_bag_fields({header, ByteOrder::kLittle, {name_, part_, header_begin}}), data};
  }

  /// Reads the connections outside of chunks: the index repeats those of chunks that cannot be read.
  void read_connections(ByteCursor cursor) {
    SkippedRecords noted_later;
    while (!cursor.empty() && !is_cut_off(cursor))
      noted_later.attempt([&] {
        const BagRecord record = next_record(cursor);
        if (record.number("op", 1) == kBagConnection) read_connection(record);
        return true;
      });
  }

  void read_record(ByteCursor& cursor) {
    if (ByteCursor ahead = cursor; ahead.skip_zeros() >= 2 * kLengthBytes) {
      cursor.skip_zeros();
      records_.attempt([&]() -> bool { cursor.fail("zeros in place of a record"); });
      return;
    }
    const auto record = records_.attempt([&] {
      BagRecord next = next_record(cursor);
      return std::pair(next, next.number("op", 1));
    });
    if (!record) return;
    if (record->second == kBagHeader) refuse_encryption(record->first);
    if (record->second == kBagConnection)
      records_.attempt([&] { return read_connection(record->first), true; });
    if (record->second == kBagMessage) read_message(record->first);
    if (record->second == kBagChunk) read_chunk(record->first);
  }

  static void refuse_encryption(const BagRecord& record) {
    const auto encryptor = record.header.find("encryptor");
    if (encryptor != record.header.end() && !encryptor->second.empty())
      record.data.fail("the bag is encrypted");
  }

  void read_connection(const BagRecord& record) {
    const BagFields fields = read_bag_fields(record.data);
    const auto type = fields.find("type");
    if (type == fields.end()) record.data.fail("a connection without a type");
    const auto definition = fields.find("message_definition");
    channels_[record.number("conn", 4)] = {
        std::string(record.field("topic")), short_type(type->second), MessageEncoding::kRos1,
        std::string(definition == fields.end() ? std::string_view{} : definition->second)};
  }

  /// The channel and the time of a message.
  std::pair<const RosChannel*, Stamp> parse_message(const BagRecord& record) const {
    const auto channel = channels_.find(record.number("conn", 4));
    if (channel == channels_.end()) record.data.fail("a message of an unknown connection");
    const std::uint64_t time = record.number("time", 8);  // u32 seconds, u32 nanoseconds
    const auto seconds = static_cast<std::int64_t>(time & 0xffffffffU);
    const auto nanoseconds = static_cast<std::int64_t>(time >> 32U);
    return {&channel->second, {seconds * kNanosecondsPerSecond + nanoseconds}};
  }

  void read_message(const BagRecord& record) {
    const auto message = records_.attempt([&] { return parse_message(record); });
    if (!message) return;
    ByteCursor data = record.data;
    const bool is_read = visitor_.reads(*message->first);
    visitor_.take({*message->first, message->second, is_read ? data.rest() : std::string_view{}, name_});
  }

  void read_chunk(const BagRecord& record) {
    const std::string place = "the chunk at byte " + std::to_string(record.data.position());
    const auto unpacked = chunks_.attempt([&] { return unpack_chunk(record, place); });
    if (!unpacked) return;
    part_ = place;
    ByteCursor records(*unpacked, ByteOrder::kLittle, {name_, part_});
    while (!records.empty() && !is_cut_off(records)) read_record(records);
    if (!records.empty()) records_.attempt([&]() -> bool { records.fail("the chunk ends within a record"); });
    part_.clear();
  }

  std::string unpack_chunk(const BagRecord& record, const std::string& place) const {
    ByteCursor data = record.data;
    if (!part_.empty()) data.fail("a chunk within a chunk");
    const std::string_view compression = record.field("compression");
    const std::uint64_t size = record.number("size", 4);
    const std::size_t limit = std::min<std::size_t>(size, kMaxDecompressed);
    std::string unpacked;
    if (compression == "none")
      unpacked = data.rest();
    else if (compression == "bz2")
      unpacked = decompress_bzip2(name_ + ": " + place, data.rest(), limit);
    else if (compression == "lz4")
      unpacked = decompress_lz4(name_ + ": " + place, data.rest(), limit);
    else
      data.fail("unknown compression '" + std::string(compression) + "'");
    if (unpacked.size() != size) data.fail("the chunk's length differs from the stated one");
    return unpacked;
  }

  const std::string& name_;
  const RosVisitor& visitor_;
  std::string part_;  ///< the chunk being read; empty outside chunks
  std::map<std::uint64_t, RosChannel> channels_;
  SkippedRecords chunks_, records_;
};

}  // namespace

std::vector<std::string> visit_ros1_bag(const std::string& name, std::string_view bytes,
                                        const RosVisitor& visitor) {
  return Ros1BagReader(name, visitor).read(bytes);
}

}  // namespace radioslam
