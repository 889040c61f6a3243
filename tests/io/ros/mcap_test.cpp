#include "radioslam/io/ros/mcap.hpp"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include "io/refusal.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

std::vector<std::string> visit(const std::string& bytes) {
  NotedMessages noted;
  EXPECT_EQ(visit_mcap("x.mcap", bytes, noted.visitor()), std::vector<std::string>{});
  return noted.lines;
}

std::string lz4_of(const std::string& content) {
  std::string packed(LZ4F_compressFrameBound(content.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr));
  return packed;
}

std::string zstd_of(const std::string& content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 1));
  return packed;
}

std::uint32_t checksum(const std::string& content) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()));
}

TEST(Mcap, ReadsMessagesInAndOutOfChunks) {
  const std::string records = mcap_records(kWrittenMessages);
  EXPECT_EQ(visit(mcap_of(records)), kNotedLines);
  EXPECT_EQ(visit(mcap_of(mcap_chunk(records, "", records, checksum(records)))), kNotedLines);
  EXPECT_EQ(visit(mcap_of(mcap_chunk(records, "lz4", lz4_of(records)))), kNotedLines);
  EXPECT_EQ(visit(mcap_of(mcap_chunk(records, "zstd", zstd_of(records)))), kNotedLines);
}

TEST(Mcap, ReadsNothingBehindTheData) {
  const std::string records = mcap_records(kWrittenMessages);
  EXPECT_EQ(visit(mcap_of(records) + records + "\x89MCAP0\r\n"), kNotedLines)
      << "the summary repeats the channels";
}

TEST(Mcap, ReadsWhatPrecedesACut) {
  const std::string whole = mcap_of(mcap_records(kWrittenMessages));
  for (const std::size_t missing : {std::size_t{1}, kMcapEnd.size(), kMcapEnd.size() + 2}) {
    NotedMessages noted;
    const auto warnings = visit_mcap("x.mcap", whole.substr(0, whole.size() - missing), noted.visitor());
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("the file is truncated"), std::string::npos);
    EXPECT_EQ(noted.lines.size(), missing > kMcapEnd.size() ? 1U : 2U);
  }
}

TEST(Mcap, LeavesForeignEncodingsOut) {
  NotedMessages noted;
  const auto warnings =
      visit_mcap("x.mcap", mcap_of(mcap_records(kWrittenMessages, "protobuf")), noted.visitor());
  EXPECT_EQ(warnings, std::vector<std::string>{"x.mcap: messages encoded as 'protobuf' are left out"});
  EXPECT_TRUE(noted.lines.empty());
}

/// What of `content` is passed on, and the warnings.
std::pair<std::vector<std::string>, std::string> visit_damaged(const std::string& content) {
  NotedMessages noted;
  std::string warnings;
  for (const auto& warning : visit_mcap("x.mcap", content, noted.visitor())) warnings += warning + '\n';
  return {noted.lines, warnings};
}

const std::string kSound = mcap_records(kWrittenMessages);

TEST(Mcap, SkipsAndNotesRecordsThatCannotBeRead) {
  const auto skip = [](const std::string& damaged, const char* words) {
    const auto [lines, warnings] = visit_damaged(mcap_of(damaged + kSound));
    EXPECT_EQ(lines, kNotedLines) << words;
    EXPECT_NE(warnings.find(words), std::string::npos) << warnings;
    EXPECT_NE(warnings.find("1 record is left out; the first: x.mcap: "), std::string::npos) << warnings;
  };
  skip(mcap_record(0x05, little(9, 2) + little(0, 20)), "at byte ");
  skip(mcap_record(0x05, little(9, 2) + little(0, 20)), "a message of an unknown channel");
  skip(mcap_record(0x05, little(0, 2) + little(0, 4) + little(~0ULL, 8) + little(0, 8)), "implausible");
  skip(mcap_record(0x04, little(9, 2) + little(5, 2) + counted("/a") + counted("cdr")), "unknown schema");
  skip(mcap_record(0x04, "x"), "unexpected end of the data");
  skip(std::string(3000, '\0'), "zeros in place of a record");
}

TEST(Mcap, SkipsAndNotesChunksThatCannotBeRead) {
  const auto skip = [](const std::string& chunk, const char* words) {
    const std::string sound = mcap_chunk(kSound, "zstd", zstd_of(kSound));
    const auto [lines, warnings] = visit_damaged(mcap_of(chunk + sound));
    EXPECT_EQ(lines, kNotedLines) << words;
    EXPECT_NE(warnings.find("1 chunk is left out; the first: x.mcap: "), std::string::npos) << warnings;
    EXPECT_NE(warnings.find(words), std::string::npos) << warnings;
  };
  skip(mcap_chunk(kSound, "", kSound, 1), "wrong checksum");
  skip(mcap_chunk(kSound, "", kSound + "x"), "the chunk's length differs");
  skip(mcap_chunk(kSound, "zip", kSound), "unknown compression 'zip'");
  skip(mcap_chunk(kSound, "lz4", "garbage"), "the chunk at byte");
  skip(mcap_chunk(kSound, "lz4", lz4_of(kSound).substr(0, 20)), "truncated");
  skip(mcap_chunk(kSound, "zstd", zstd_of(kSound + kSound)), "larger than");
  const std::string nested = mcap_chunk(kSound, "", kSound);
  skip(mcap_chunk(nested, "", nested), "a chunk within a chunk");
}

TEST(Mcap, ReadsAChunkUpToItsDamage) {
  const std::string torn = kSound + kSound.substr(0, kSound.size() - 1);
  const auto [lines, warnings] = visit_damaged(mcap_of(mcap_chunk(torn, "", torn)));
  EXPECT_EQ(lines.size(), 3U);
  EXPECT_NE(warnings.find("the chunk ends within a record"), std::string::npos) << warnings;
}

TEST(Mcap, TakesChannelsOfALostChunkFromTheSummary) {
  const std::string message_alone =  // of a channel whose records were in the lost chunk
      mcap_record(0x05, little(0, 2) + little(0, 4) + little(5, 8) + little(5, 8) + "again");
  const auto [lines, warnings] =
      visit_damaged(mcap_of(mcap_chunk(kSound, "", kSound, 1) + message_alone) + kSound);
  EXPECT_EQ(lines, std::vector<std::string>{"/a std_msgs/String 5 again"}) << warnings;
}

TEST(Mcap, TakesZerosForTheEndOfTheFile) {
  const auto [lines, warnings] = visit_damaged("\x89MCAP0\r\n" + kSound + std::string(5000, '\0'));
  EXPECT_EQ(lines, kNotedLines);
  EXPECT_NE(warnings.find("the file has only zeros from here on; the data before this are read"),
            std::string::npos)
      << warnings;
}

}  // namespace
}  // namespace radioslam
