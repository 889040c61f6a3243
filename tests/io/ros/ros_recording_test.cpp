#include "radioslam/io/ros/ros_recording.hpp"

#include <zstd.h>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/ros/ros_topics.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

WrittenMessage message_at(std::int64_t seconds) {
  return {"/a", "std_msgs/String", seconds * 1'000'000'000, std::to_string(seconds)};
}

std::string mcap_at(std::int64_t begin_s, std::int64_t end_s) {
  return mcap_of(mcap_records({message_at(begin_s), message_at(end_s)}));
}

std::string zstd_of(const std::string& content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 1));
  return packed;
}

/// The bytes of all messages, and the warnings.
std::pair<std::string, std::string> read(const std::filesystem::path& source) {
  std::string messages, warnings;
  const auto all = visit_recording(
      source, {[](const RosChannel&) { return true; },
               [&](const RosMessage& message) { messages += std::string(message.bytes) + ' '; }});
  for (const std::string& warning : all) warnings += warning + '\n';
  return {messages, warnings};
}

TEST(RosRecording, ReadsCompressedPartsAmongOthers) {
  const TemporaryFolder folder;
  const auto first = folder.write("k_0.mcap.zstd", zstd_of(mcap_at(1, 2)));
  folder.write("k_1.mcap", mcap_at(3, 4));
  folder.write("k_2.mcap.zst", zstd_of(mcap_at(5, 6)));
  folder.write("k_3.bag.active", bag_of(bag_records({message_at(7)})));
  EXPECT_EQ(read(folder.path()), std::pair(std::string("1 2 3 4 5 6 7 "), std::string()));
  EXPECT_EQ(read(first).first, "1 2 ");
}

TEST(RosRecording, ReadsAPartOnceThatIsThereTwice) {
  const TemporaryFolder folder;
  folder.write("k_0.mcap.zstd", zstd_of(mcap_at(1, 2)).substr(0, 20));  // the recorder was killed
  folder.write("k_0.mcap", mcap_at(1, 2));
  const auto [messages, warnings] = read(folder.path());
  EXPECT_EQ(messages, "1 2 ");
  EXPECT_NE(warnings.find("k_0.mcap.zstd: is left out beside the same part uncompressed"), std::string::npos);
}

TEST(RosRecording, NamesPartsThatAreNotThere) {
  const TemporaryFolder folder;
  folder.write("k_1.mcap", mcap_at(1, 2));
  folder.write("k_2.mcap.gz", "x");
  folder.write("metadata.yaml",
               "rosbag2_bagfile_information:\n  relative_file_paths: [k_0.mcap, bag/k_1.mcap.zstd]\n");
  const auto [messages, warnings] = read(folder.path());
  EXPECT_EQ(messages, "1 2 ");
  EXPECT_NE(warnings.find("metadata.yaml: names k_0.mcap, which is not there"), std::string::npos)
      << warnings;
  EXPECT_EQ(warnings.find("names k_1"), std::string::npos) << "it is there, uncompressed";
  EXPECT_NE(warnings.find("k_2.mcap.gz: is not read"), std::string::npos) << warnings;
  folder.write("metadata.yaml", "{");
  EXPECT_EQ(read(folder.path()).first, "1 2 ");
}

TEST(RosRecording, SkipsAFileThatIsNoRecordingUnlessItIsTheOnlyOne) {
  const TemporaryFolder folder;
  const auto bad = folder.write("b.db3", "no database");
  expect_refusal([&] { read(folder.path()); }, 0, "b.db3: at byte 0: not a recording");
  expect_refusal([&] { read(bad); }, 0, "b.db3: at byte 0: not a recording");
  folder.write("a.mcap", mcap_at(1, 2));
  folder.write("c.db3", "");
  const auto [messages, warnings] = read(folder.path());
  EXPECT_EQ(messages, "1 2 ");
  EXPECT_NE(warnings.find("2 files are left out; the first: "), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("b.db3: at byte 0: not a recording"), std::string::npos) << warnings;
}

TEST(RosRecording, PassesOnTheErrorsOfItsVisitor) {
  const TemporaryFolder folder;
  folder.write("a.mcap", mcap_at(1, 2));
  folder.write("b.mcap", mcap_at(1, 2));
  const RosVisitor full{[](const RosChannel&) { return true; },
                        [](const RosMessage&) { throw InputError("disk", 0, "cannot be written"); }};
  expect_refusal([&] { visit_recording(folder.path(), full); }, 0, "disk: cannot be written");
}

TEST(RosRecording, OfNothingReadableIsRefusedWithItsDamage) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.mcap", "\x89MCAP0\r\n" + std::string(100, '\0'));
  expect_refusal([&] { index_recording(file); }, 0, "has no readable messages: ");
}

std::vector<std::string> names_in(const TemporaryFolder& folder) {
  std::vector<std::string> names;
  for (const auto& path : recordings_in(folder.path())) names.push_back(recording_name(path));
  return names;
}

TEST(RosRecording, AFolderIsOneRecordingOrOnePerBag) {
  const TemporaryFolder parts, overlapping, named, listed, nested;
  parts.write("k_0.mcap", mcap_at(1, 3));
  parts.write("k_1.mcap.zstd", zstd_of(mcap_at(3, 5)));
  EXPECT_EQ(recordings_in(parts.path()), std::vector<std::filesystem::path>{parts.path()});
  parts.write("k_2.mcap", mcap_at(1, 3));
  EXPECT_EQ(recordings_in(parts.path()).size(), 1U) << "a copy of a part";
  overlapping.write("robot1.bag", bag_of(bag_records({message_at(1), message_at(9)})));
  overlapping.write("robot2.bag", bag_of(bag_records({message_at(2), message_at(8)})));
  EXPECT_EQ(names_in(overlapping), (std::vector<std::string>{"robot1", "robot2"}));
  named.write("north.mcap", mcap_at(1, 2));
  named.write("south.db3.zstd", "");
  EXPECT_EQ(names_in(named), (std::vector<std::string>{"north", "south"}));
  listed.write("x.mcap", mcap_at(1, 9));
  listed.write("y.mcap", mcap_at(1, 9));
  listed.write("metadata.yaml", "");
  EXPECT_EQ(recordings_in(listed.path()), std::vector<std::filesystem::path>{listed.path()});
  for (const char* robot : {"a", "b"}) {
    std::filesystem::create_directories(nested.path() / robot);
    nested.write(std::string(robot) + "/bag_0.mcap", mcap_at(1, 9));
  }
  EXPECT_EQ(names_in(nested), (std::vector<std::string>{"a", "b"}));
}

}  // namespace
}  // namespace radioslam
