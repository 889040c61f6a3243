#include "radioslam/io/ros/ros1_bag.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include "io/refusal.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

std::vector<std::string> visit_bag(const std::string& bytes) {
  NotedMessages noted;
  EXPECT_EQ(visit_ros1_bag("x.bag", bytes, noted.visitor()), std::vector<std::string>{});
  return noted.lines;
}

std::string bz2_of(std::string content) {
  std::string packed(content.size() + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, content.data(), static_cast<unsigned>(content.size()), 1, 0,
                           0);
  packed.resize(size);
  return packed;
}

std::string lz4_chunk(const std::string& content) {
  std::string packed(LZ4F_compressFrameBound(content.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr));
  return packed;
}

TEST(Ros1Bag, ReadsMessagesInAndOutOfChunks) {
  const std::string records = bag_records(kWrittenMessages);
  EXPECT_EQ(visit_bag(bag_of(records)), kNotedLines);
  const std::string index = bag_record({"op=\x04", "ver=" + little(1, 4)}, "12345678");
  EXPECT_EQ(visit_bag(bag_of(bag_chunk(records, "none", records) + index)), kNotedLines);
  EXPECT_EQ(visit_bag(bag_of(bag_chunk(records, "bz2", bz2_of(records)))), kNotedLines);
  EXPECT_EQ(visit_bag(bag_of(bag_chunk(records, "lz4", lz4_chunk(records)))), kNotedLines);
}

TEST(Ros1Bag, ReadsWhatPrecedesACut) {
  const std::string whole = bag_of(bag_records(kWrittenMessages));
  NotedMessages noted;
  const auto warnings = visit_ros1_bag("x.bag", whole.substr(0, whole.size() - 1), noted.visitor());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("the file is truncated"), std::string::npos);
  EXPECT_EQ(noted.lines.size(), 1U);
}

/// What of `content` is passed on, and the warnings.
std::pair<std::vector<std::string>, std::string> visit_damaged(const std::string& content) {
  NotedMessages noted;
  std::string warnings;
  for (const auto& warning : visit_ros1_bag("x.bag", content, noted.visitor())) warnings += warning + '\n';
  return {noted.lines, warnings};
}

TEST(Ros1Bag, SkipsAndNotesWhatCannotBeRead) {
  const std::string records = bag_records(kWrittenMessages);
  const auto skip = [&](const std::string& damaged, const char* what, const char* words) {
    const auto [lines, warnings] = visit_damaged(bag_of(damaged + records));
    EXPECT_EQ(lines, kNotedLines) << words;
    EXPECT_NE(warnings.find(std::string("1 ") + what + " is left out; the first: x.bag: "), std::string::npos)
        << warnings;
    EXPECT_NE(warnings.find(words), std::string::npos) << warnings;
  };
  skip(bag_record({"op=\x02", "conn=" + little(7, 4), "time=" + little(0, 8)}, ""), "record",
       "unknown connection");
  skip(bag_record({"op=\x02"}, ""), "record", "at byte ");
  skip(bag_record({"op=\x02"}, ""), "record", "a record without conn");
  skip(bag_record({"op=\x02", "conn=x"}, ""), "record", "conn has a wrong length");
  skip(bag_record({"no equals"}, ""), "record", "no '='");
  skip(bag_record({"op=\x07", "conn=" + little(0, 4), "topic=/a"}, ""), "record",
       "a connection without a type");
  skip(std::string(800, '\0'), "record", "zeros in place of a record");
  skip(bag_chunk(records, "zip", records), "chunk", "unknown compression 'zip'");
  skip(bag_chunk(records, "none", records + "x"), "chunk", "the chunk's length differs");
  skip(bag_chunk(records, "bz2", "garbage"), "chunk", "the chunk at byte");
  const std::string nested = bag_chunk(records, "none", records);
  skip(bag_chunk(nested, "none", nested), "chunk", "a chunk within a chunk");
}

TEST(Ros1Bag, RefusesEncryptedBags) {
  expect_refusal(
      [&] {
        visit_bag(bag_of(bag_record({"op=\x03", "encryptor=rosbag/AesCbcEncryptor"}, "")));
      },
      0, "encrypted");
}

TEST(Ros1Bag, ReadsUpToZerosOfALostEnd) {
  const std::string records = bag_records(kWrittenMessages);
  const std::string zeros(5000, '\0');
  const auto [lines, warnings] = visit_damaged(bag_of(records + zeros));
  EXPECT_EQ(lines, kNotedLines);
  EXPECT_NE(warnings.find("has only zeros from here on"), std::string::npos) << warnings;
  const auto inside = visit_damaged(bag_of(bag_chunk(records + zeros, "none", records + zeros)));
  EXPECT_EQ(inside.first, kNotedLines);
  EXPECT_NE(inside.second.find("the chunk ends within a record"), std::string::npos) << inside.second;
}

TEST(Ros1Bag, TakesConnectionsOfALostChunkFromTheIndex) {
  const std::string records = bag_records(kWrittenMessages);
  const std::string message =
      bag_record({"op=\x02", "conn=" + little(0, 4), "time=" + little(1, 4) + little(5, 4)}, "again");
  const auto [lines, warnings] = visit_damaged(
      bag_of(bag_chunk(records, "bz2", "garbage") + bag_chunk(message, "none", message) +
             bag_record({"op=\x07", "conn=" + little(0, 4), "topic=/a"}, counted("type=std_msgs/String"))));
  EXPECT_EQ(lines, std::vector<std::string>{"/a std_msgs/String 1000000005 again"}) << warnings;
}

}  // namespace
}  // namespace radioslam
