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

TEST(Mcap, RefusesWithTheByte) {
  const std::string records = mcap_records(kWrittenMessages);
  const auto refuse = [](const std::string& content, const char* words) {
    expect_refusal([&] { visit(mcap_of(content)); }, 0, words);
  };
  refuse(mcap_record(0x05, little(9, 2) + little(0, 20)), "at byte ");
  refuse(mcap_record(0x05, little(9, 2) + little(0, 20)), "a message of an unknown channel");
  refuse(mcap_record(0x04, little(0, 2) + little(5, 2) + counted("/a") + counted("cdr")), "unknown schema");
  refuse(mcap_record(0x04, "x"), "unexpected end of the data");
  refuse(mcap_chunk(records, "", records, 1), "wrong checksum");
  refuse(mcap_chunk(records, "", records + "x"), "the chunk's length differs");
  refuse(mcap_chunk(records, "zip", records), "unknown compression 'zip'");
  refuse(mcap_chunk(records, "lz4", "garbage"), "the chunk at byte");
  refuse(mcap_chunk(records, "lz4", lz4_of(records).substr(0, 20)), "truncated");
  refuse(mcap_chunk(records, "zstd", zstd_of(records + records)), "larger than");
  const std::string nested = mcap_chunk(records, "", records);
  refuse(mcap_chunk(nested, "", nested), "a chunk within a chunk");
  const std::string torn = records.substr(0, records.size() - 1);
  refuse(mcap_chunk(torn, "", torn), "the chunk at byte");
}

}  // namespace
}  // namespace radioslam
