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

TEST(Ros1Bag, RefusesWithTheByte) {
  const auto refuse = [](const std::string& content, const char* words) {
    expect_refusal([&] { visit_bag(bag_of(content)); }, 0, words);
  };
  const std::string records = bag_records(kWrittenMessages);
  refuse(bag_record({"op=\x02", "conn=" + little(7, 4), "time=" + little(0, 8)}, ""), "unknown connection");
  refuse(bag_record({"op=\x02"}, ""), "at byte ");
  refuse(bag_record({"op=\x02"}, ""), "a record without conn");
  refuse(bag_record({"op=\x02", "conn=x"}, ""), "conn has a wrong length");
  refuse(bag_record({"no equals"}, ""), "no '='");
  refuse(bag_record({"op=\x07", "conn=" + little(0, 4), "topic=/a"}, ""), "a connection without a type");
  refuse(bag_chunk(records, "zip", records), "unknown compression 'zip'");
  refuse(bag_chunk(records, "none", records + "x"), "the chunk's length differs");
  refuse(bag_chunk(records, "bz2", "garbage"), "the chunk at byte");
  const std::string nested = bag_chunk(records, "none", records);
  refuse(bag_chunk(nested, "none", nested), "a chunk within a chunk");
  refuse(bag_record({"op=\x03", "encryptor=rosbag/AesCbcEncryptor"}, ""), "encrypted");
}

}  // namespace
}  // namespace radioslam
