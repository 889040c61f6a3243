#include "radioslam/records/team_log.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "radioslam/base/wire.hpp"
#include "radioslam/records/log_chunks.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kMagic = "RSL2";
constexpr std::size_t kMaxChunkRecords = 256, kMaxChunkBytes = 60000, kMaxRefusals = 8, kMaxDamaged = 16,
                      kChunkFrame = 32;  // bytes of a chunk without its records and the robot's name
constexpr std::uint64_t kMaxRecords = std::uint64_t{1} << 40U;

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t k = 0; k < 256; ++k) {
    std::uint32_t value = k;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? 0xedb88320U ^ (value >> 1U) : value >> 1U;
    table[k] = value;
  }
  return table;
}

/// CRC-32 as in zlib, of `bytes` after those of `before`.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) {
  static constexpr auto kTable = crc_table();
  std::uint32_t crc = ~before;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 255U] ^ (crc >> 8U);
  return ~crc;
}

/// The chunk at the beginning of the bytes; nothing if there is none.
std::optional<LogChunk> read_chunk(std::string_view bytes) {
  WireReader in(bytes);
  if (in.take(kMagic.size()) != kMagic) return std::nullopt;
  LogChunk chunk;
  const std::string_view name = in.take(in.count(1));
  if (!is_record_name(name)) return std::nullopt;
  chunk.robot = std::string(name);
  chunk.life = in.u32();
  chunk.first = in.whole();
  const std::size_t count = in.count(1);
  if (!in.good() || count == 0 || count > kMaxChunkRecords || chunk.first > kMaxRecords) return std::nullopt;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t record_bytes = in.count(1);
    if (!in.good() || record_bytes == 0 || record_bytes > kMaxRecordBytes) return std::nullopt;
    chunk.records.push_back(in.take(record_bytes));
  }
  const std::size_t covered = bytes.size() - in.left();
  const std::uint32_t stated = in.u32();
  if (!in.good() || covered > kMaxChunkBytes || crc32(bytes.substr(0, covered)) != stated)
    return std::nullopt;
  chunk.bytes = bytes.substr(0, covered + 4);
  return chunk;
}

/// Why a chunk cannot be taken; empty if it can.
std::string contradiction(const LogChunk& chunk, const KnownLog* known) {
  const std::string name = "robot " + chunk.robot + ": ";
  if (known && known->life != chunk.life)
    return name + "these records are of another recording than those before";
  for (std::size_t k = 0; k < chunk.records.size(); ++k) {
    const std::uint64_t number = chunk.first + k;
    const auto found =
        known ? known->records.find(number) : std::map<std::uint64_t, std::string>::const_iterator{};
    if (known && found != known->records.end()) {
      if (found->second == chunk.records[k]) continue;
      return name + "record " + std::to_string(number) + " differs from the one known";
    }
    if (!decode_record(chunk.records[k]))
      return name + "record " + std::to_string(number) + " is not understood";
  }
  return {};
}

/// The chunk of the records from `first` up to before `end` that fit into so many bytes; moves `first`.
template <class Index, class RecordAt>
std::string next_chunk(const std::pair<std::string_view, std::uint32_t>& robot_life, Index& first, Index end,
                       std::size_t most_bytes, const RecordAt& record) {
  const auto& [robot, life] = robot_life;
  std::size_t size = kChunkFrame + robot.size();
  Index last = first;
  for (; last < end && last - first < kMaxChunkRecords; ++last) {
    size += record(last).size() + 3;
    if (last > first && size > most_bytes) break;
  }
  WireWriter out;
  out.append(kMagic);
  out.whole(robot.size());
  out.append(robot);
  out.u32(life);
  out.whole(first);
  out.whole(last - first);
  for (; first < last; ++first) {
    out.whole(record(first).size());
    out.append(record(first));
  }
  out.u32(crc32(out.bytes()));
  return out.take();
}

}  // namespace

std::vector<LogChunk> chunks_of(std::string_view bytes) {
  std::vector<LogChunk> chunks;
  while (auto chunk = read_chunk(bytes.substr(0, kMaxChunkBytes + 4))) {
    bytes.remove_prefix(chunk->bytes.size());
    chunks.push_back(*std::move(chunk));
  }
  return chunks;
}

std::uint32_t RobotLog::life() const {
  std::uint32_t life = crc32(robot);
  for (const std::string& record : records) life = crc32(record, life);
  return life;
}

std::string RobotLog::bytes(std::size_t first, std::size_t end) const {
  end = std::min(end, records.size());
  const std::uint32_t life = this->life();
  std::string all;
  const auto record = [this](std::uint64_t k) -> const std::string& { return records[k]; };
  while (first < end) all += next_chunk({robot, life}, first, end, kMaxChunkBytes, record);
  return all;
}

std::pair<std::string, std::uint64_t> KnownLog::bytes(const std::string& robot, std::uint64_t first,
                                                      std::uint64_t end, std::size_t most_bytes) const {
  std::string all;
  const auto record = [this](std::uint64_t k) -> const std::string& { return records.at(k); };
  const auto fits = [&] {
    return all.size() + kChunkFrame + robot.size() + record(first).size() + 3 <= most_bytes;
  };
  while (first < end && (all.empty() || fits()))
    all += next_chunk({robot, life}, first, end,
                      std::min(kMaxChunkBytes, most_bytes - std::min(most_bytes, all.size())), record);
  return {std::move(all), first};
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> KnownLog::gaps() const {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> gaps;
  std::uint64_t next = 0;
  for (const auto& [number, record] : records) {
    if (number > next) gaps.emplace_back(next, number - 1);
    next = number + 1;
  }
  return gaps;
}

void TeamLog::add(const RobotLog& own) {
  KnownLog& log = robots_[own.robot];
  log.life = own.life();
  for (std::size_t k = 0; k < own.records.size(); ++k) log.records.emplace(k, own.records[k]);
}

Acceptance TeamLog::accept(std::string_view bytes) {
  Acceptance acceptance;
  const auto refuse = [&](std::string why) {
    ++acceptance.refused;
    if (acceptance.refusals.size() < kMaxRefusals) acceptance.refusals.push_back(std::move(why));
  };
  const std::size_t all = bytes.size(), most_damaged = kMaxDamaged + all / kMaxChunkBytes;
  std::size_t damaged = 0;
  while (!bytes.empty()) {
    const std::size_t at = all - bytes.size();
    const auto chunk = read_chunk(bytes.substr(0, kMaxChunkBytes + 4));
    if (!chunk) {
      const std::size_t next = ++damaged < most_damaged ? bytes.find(kMagic, 1) : bytes.size();
      const std::size_t skipped = std::min(next, bytes.size());
      refuse("byte " + std::to_string(at) + ": " + std::to_string(skipped) + " bytes are damaged or no log");
      bytes.remove_prefix(skipped);
      continue;
    }
    bytes.remove_prefix(chunk->bytes.size());
    const auto known = robots_.find(chunk->robot);
    const std::string why = contradiction(*chunk, known == robots_.end() ? nullptr : &known->second);
    if (!why.empty()) {
      refuse(why);
      continue;
    }
    KnownLog& log = robots_[chunk->robot];
    log.life = chunk->life;
    for (std::size_t k = 0; k < chunk->records.size(); ++k)
      ++(log.records.emplace(chunk->first + k, std::string(chunk->records[k])).second ? acceptance.records
                                                                                      : acceptance.repeated);
  }
  return acceptance;
}

}  // namespace radioslam
