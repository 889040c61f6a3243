#include "radioslam/io/ros/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/base/little_endian.hpp"
#include "radioslam/io/ros/mcap_format.hpp"

namespace radioslam {
namespace {

constexpr const char* kMcapCompression = "zstd";
constexpr int kMcapLevel = 3;

/// The content of a record.
class McapContent {
 public:
  McapContent& u8(std::uint8_t value) { return number(value, 1); }
  McapContent& u16(std::uint16_t value) { return number(value, 2); }
  McapContent& u32(std::uint32_t value) { return number(value, 4); }
  McapContent& u64(std::uint64_t value) { return number(value, 8); }
  McapContent& raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  /// Preceded by its length.
  McapContent& text(std::string_view text) { return number(text.size(), 4).raw(text); }
  McapContent& map(const std::map<std::uint16_t, std::uint64_t>& entries) {
    u32(static_cast<std::uint32_t>(entries.size() * (2 + 8)));
    for (const auto& [key, value] : entries) u16(key).u64(value);
    return *this;
  }

  std::string record(McapOpcode opcode) const {
    std::string record;
    append_little_endian(record, opcode, 1);
    append_little_endian(record, bytes_.size(), 8);
    return record + bytes_;
  }

 private:
  McapContent& number(std::uint64_t value, std::size_t size) {
    append_little_endian(bytes_, value, size);
    return *this;
  }

  std::string bytes_;
};

std::string pack_chunk(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kMcapLevel);
  RADIOSLAM_CHECK(ZSTD_isError(size) == 0, "a chunk fits into its bound");
  packed.resize(size);
  return packed;
}

std::uint64_t nanoseconds(double seconds) {
  return static_cast<std::uint64_t>(Stamp::from_seconds(seconds).ns);
}

std::uint16_t next_id(std::size_t count) {
  RADIOSLAM_CHECK(count < std::numeric_limits<std::uint16_t>::max(), "MCAP numbers channels in 16 bits");
  return static_cast<std::uint16_t>(count);
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& target) : file_(target) {
  write(kMcapMagic);
  write(McapContent().text("ros2").text("radioslam").record(kMcapHeader));
}

void McapWriter::write(std::string_view bytes) {
  file_.append(bytes);
  checksum_ = mcap_checksum(bytes, checksum_);
  written_ += bytes.size();
}

/// Schema 0 means none, so that they are numbered from 1.
std::uint16_t McapWriter::schema_of(const std::string& type, const std::string& definition) {
  const auto [known, is_new] = schema_ids_.emplace(std::pair(type, definition), next_id(schemas_.size() + 1));
  if (is_new) {
    schemas_.push_back({type, definition});
    chunk_ += schema_record(known->second);
  }
  return known->second;
}

std::uint16_t McapWriter::channel_of(const std::string& topic, const std::string& type,
                                     const std::string& definition) {
  const std::uint16_t schema = schema_of(type, definition);
  const auto [known, is_new] = channel_ids_.emplace(std::pair(topic, schema), next_id(channels_.size()));
  if (is_new) {
    channels_.push_back({schema, topic});
    chunk_ += channel_record(known->second);
  }
  return known->second;
}

std::string McapWriter::schema_record(std::uint16_t id) const {
  const Schema& schema = schemas_[id - 1U];
  return McapContent().u16(id).text(schema.type).text("ros2msg").text(schema.definition).record(kMcapSchema);
}

std::string McapWriter::channel_record(std::uint16_t id) const {
  const Channel& channel = channels_[id];
  return McapContent()
      .u16(id)
      .u16(channel.schema)
      .text(channel.topic)
      .text("cdr")
      .map({})
      .record(kMcapChannel);
}

void McapWriter::add(const std::string& topic, const std::string& type, const std::string& definition,
                     Stamp stamp, std::string_view cdr) {
  const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, stamp.ns));
  const bool is_late = time_ns > chunk_begin_ns_ + nanoseconds(kChunk_s);
  if (!chunk_messages_.empty() && (is_late || chunk_.size() + cdr.size() > kChunkBytes)) close_chunk();
  const std::uint16_t channel = channel_of(topic, type, definition);
  const bool is_first = chunk_messages_.empty();
  chunk_begin_ns_ = is_first ? time_ns : std::min(chunk_begin_ns_, time_ns);
  chunk_end_ns_ = is_first ? time_ns : std::max(chunk_end_ns_, time_ns);
  chunk_messages_[channel].emplace_back(time_ns, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(channels_[channel].messages++);
  chunk_ += McapContent().u16(channel).u32(sequence).u64(time_ns).u64(time_ns).raw(cdr).record(kMcapMessage);
}

void McapWriter::close_chunk() {
  if (chunk_messages_.empty()) return;
  const std::string packed = pack_chunk(chunk_);
  const std::string chunk = McapContent()
                                .u64(chunk_begin_ns_)
                                .u64(chunk_end_ns_)
                                .u64(chunk_.size())
                                .u32(mcap_checksum(chunk_))
                                .text(kMcapCompression)
                                .u64(packed.size())
                                .raw(packed)
                                .record(kMcapChunk);
  ChunkIndex index{.begin_ns = chunk_begin_ns_,
                   .end_ns = chunk_end_ns_,
                   .start = written_,
                   .length = chunk.size(),
                   .packed = packed.size(),
                   .unpacked = chunk_.size()};
  write(chunk);
  for (auto& [channel, messages] : chunk_messages_) {
    std::stable_sort(messages.begin(), messages.end());
    McapContent content;
    content.u16(channel).u32(static_cast<std::uint32_t>(messages.size() * (8 + 8)));
    for (const auto& [time_ns, offset] : messages) content.u64(time_ns).u64(offset);
    index.message_indexes[channel] = written_;
    write(content.record(kMcapMessageIndex));
  }
  index.index_length = written_ - index.start - index.length;
  file_.flush();
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_messages_.clear();
}

std::string McapWriter::chunk_index_record(const ChunkIndex& index) {
  return McapContent()
      .u64(index.begin_ns)
      .u64(index.end_ns)
      .u64(index.start)
      .u64(index.length)
      .map(index.message_indexes)
      .u64(index.index_length)
      .text(kMcapCompression)
      .u64(index.packed)
      .u64(index.unpacked)
      .record(kMcapChunkIndex);
}

std::string McapWriter::statistics_record() const {
  std::map<std::uint16_t, std::uint64_t> counts;
  std::uint64_t all = 0, begin_ns = 0, end_ns = 0;
  for (std::size_t k = 0; k < channels_.size(); ++k)
    all += counts[static_cast<std::uint16_t>(k)] = channels_[k].messages;
  if (!chunks_.empty()) begin_ns = chunks_.front().begin_ns;
  for (const ChunkIndex& chunk : chunks_) {
    begin_ns = std::min(begin_ns, chunk.begin_ns);
    end_ns = std::max(end_ns, chunk.end_ns);
  }
  return McapContent()
      .u64(all)
      .u16(static_cast<std::uint16_t>(schemas_.size()))
      .u32(static_cast<std::uint32_t>(channels_.size()))
      .u32(0)  // attachments
      .u32(0)  // metadata
      .u32(static_cast<std::uint32_t>(chunks_.size()))
      .u64(begin_ns)
      .u64(end_ns)
      .map(counts)
      .record(kMcapStatistics);
}

/// The summary, the offsets of its groups, and the footer.
std::string McapWriter::summary() const {
  const std::uint64_t start = written_;
  std::string summary, offsets;
  const auto add_group = [&](McapOpcode opcode, const std::string& group) {
    if (group.empty()) return;
    offsets +=
        McapContent().u8(opcode).u64(start + summary.size()).u64(group.size()).record(kMcapSummaryOffset);
    summary += group;
  };
  std::string schemas, channels, chunks;
  for (std::size_t k = 0; k < schemas_.size(); ++k)
    schemas += schema_record(static_cast<std::uint16_t>(k + 1));
  for (std::size_t k = 0; k < channels_.size(); ++k)
    channels += channel_record(static_cast<std::uint16_t>(k));
  for (const ChunkIndex& chunk : chunks_) chunks += chunk_index_record(chunk);
  add_group(kMcapSchema, schemas);
  add_group(kMcapChannel, channels);
  add_group(kMcapStatistics, statistics_record());
  add_group(kMcapChunkIndex, chunks);
  const std::uint64_t offsets_start = start + summary.size();
  // The checksum is of all of this up to itself, the last four bytes of the record.
  const std::string footer = McapContent().u64(start).u64(offsets_start).u32(0).record(kMcapFooter);
  std::string all = summary + offsets + footer.substr(0, footer.size() - 4);
  append_little_endian(all, mcap_checksum(all), 4);
  return all;
}

void McapWriter::commit() {
  close_chunk();
  write(McapContent().u32(checksum_).record(kMcapDataEnd));
  write(summary());
  write(kMcapMagic);
  file_.commit();
}

}  // namespace radioslam
