#include "radioslam/io/ros/mcap_writer.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/ros/cdr_writer.hpp"
#include "radioslam/io/ros/mcap.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStringType = "std_msgs/msg/String";
constexpr const char* kString = "string data\n";
constexpr const char* kPointType = "geometry_msgs/msg/PointStamped";

std::string point_definition() {
  const std::string line = std::string(80, '=') + '\n';
  return "std_msgs/Header header\nPoint point\n" + line +
         "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + line +
         "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + line +
         "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
}

std::string point(std::int32_t seconds, double x) {
  return CdrWriter().i32(seconds).u32(5).text("map").f64(x).f64(-2).f64(0.25).take();
}

std::string text(const std::string& words) { return CdrWriter().text(words).take(); }

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

/// Points and words over ten seconds, some of them earlier than those before.
void write_example(McapWriter& writer) {
  for (int k = 0; k < 10; ++k) {
    writer.add("/r1/point", kPointType, point_definition(), at(100 + k), point(100 + k, 0.5 * k));
    if (k % 4 == 1)
      writer.add("/r1/says", kStringType, kString, at(100 + k - 0.5), text("k " + std::to_string(k)));
  }
}

std::string example() {
  const TemporaryFolder folder;
  McapWriter writer(folder.path() / "x.mcap");
  write_example(writer);
  writer.commit();
  return folder.read("x.mcap");
}

std::vector<std::string> lines_of(const std::string& bytes, std::size_t warnings = 0) {
  NotedMessages noted;
  EXPECT_EQ(visit_mcap("x.mcap", bytes, noted.visitor()).size(), warnings);
  return noted.lines;
}

TEST(McapWriter, IsReadAsItWasWritten) {
  const std::vector<std::string> lines = lines_of(example());
  ASSERT_EQ(lines.size(), 13u);
  EXPECT_EQ(lines[0], "/r1/point geometry_msgs/PointStamped 100000000000 " + point(100, 0));
  EXPECT_EQ(lines[2], "/r1/says std_msgs/String 100500000000 " + text("k 1"));
  EXPECT_EQ(lines[11], "/r1/point geometry_msgs/PointStamped 109000000000 " + point(109, 4.5));
}

TEST(McapWriter, WritesTheSameBytesAgain) { EXPECT_EQ(example(), example()); }

TEST(McapWriter, GivesATopicOfTwoTypesTwoChannels) {
  const TemporaryFolder folder;
  McapWriter writer(folder.path() / "x.mcap");
  writer.add("/a", kStringType, kString, at(1), text("one"));
  writer.add("/a", kPointType, point_definition(), at(2), point(2, 0));
  writer.commit();
  const auto lines = lines_of(folder.read("x.mcap"));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].substr(0, 18), "/a std_msgs/String");
  EXPECT_EQ(lines[1].substr(0, 29), "/a geometry_msgs/PointStamped");
}

TEST(McapWriter, IsAFileWithoutMessagesToo) {
  const TemporaryFolder folder;
  McapWriter(folder.path() / "x.mcap").commit();
  EXPECT_TRUE(lines_of(folder.read("x.mcap")).empty());
}

/// The only file of a folder.
std::string unfinished_in(const TemporaryFolder& folder) {
  for (const auto& entry : fs::directory_iterator(folder.path())) return folder.read(entry.path().filename());
  return {};
}

TEST(McapWriter, AppearsWhenItIsComplete) {
  const TemporaryFolder folder;
  {
    McapWriter writer(folder.path() / "x.mcap");
    write_example(writer);
    EXPECT_FALSE(fs::exists(folder.path() / "x.mcap"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path())) << "without a commit nothing is left";
}

TEST(McapWriter, LeavesAReadableStreamWhenTheProgramIsKilled) {
  const TemporaryFolder folder;
  McapWriter writer(folder.path() / "x.mcap");
  write_example(writer);                                  // is read while it is written
  const auto lines = lines_of(unfinished_in(folder), 1);  // that it is truncated
  ASSERT_GE(lines.size(), 10u) << "all but the last chunk";
  EXPECT_EQ(lines[0], "/r1/point geometry_msgs/PointStamped 100000000000 " + point(100, 0));
}

TEST(McapWriter, WritesChunksOfAMegabyte) {
  const TemporaryFolder folder;
  McapWriter writer(folder.path() / "x.mcap");
  for (int k = 0; k < 40; ++k)
    writer.add("/a", kStringType, kString, at(1),
               text(std::string(100'000, static_cast<char>('a' + k % 26))));
  EXPECT_EQ(lines_of(unfinished_in(folder), 1).size(), 30u) << "ten fit into one, and the last is open";
  writer.commit();
  EXPECT_EQ(lines_of(folder.read("x.mcap")).size(), 40u);
}

TEST(McapWriter, RefusesATargetThatCannotBeReplaced) {
  const TemporaryFolder folder;
  expect_refusal([&] { McapWriter writer(folder.path()); }, 0, "not a file");
}

/// What a program prints, and its exit status.
std::pair<std::string, int> run(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> block{};
  std::string out;
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), pipe))
    out.append(block.data(), got);
  return {out, ::pclose(pipe)};
}

/// The format's own library and another language's decoder of messages.
TEST(McapWriter, IsReadByTheFormatsOwnLibrary) {
  const std::string needed =
      "for (const name of ['@mcap/core', '@foxglove/rosmsg', '@foxglove/rosmsg2-serialization', 'fzstd']) "
      "require(name)";
  if (run("node -e \"" + needed + "\" 2>/dev/null").second != 0)
    GTEST_SKIP() << "needs node and in its NODE_PATH: npm install @mcap/core @foxglove/rosmsg "
                    "@foxglove/rosmsg2-serialization fzstd";
  const TemporaryFolder folder;
  const auto read = [&](const std::string& bytes) {
    return run("node " RADIOSLAM_TEST_SOURCES "/ros/read_mcap.cjs " + folder.write("x.mcap", bytes).string() +
               " 2>&1");
  };
  const auto [out, status] = read(example());
  ASSERT_EQ(status, 0) << out;
  std::string damaged = example();
  damaged[damaged.find("radioslam")] = 'R';
  EXPECT_NE(read(damaged).second, 0) << "it looks at the checksum of the data";
  std::vector<std::string> streamed, indexed, others;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    const std::string how = line.substr(0, line.find(' '));
    auto& of = how == "streamed" ? streamed : how == "indexed" ? indexed : others;
    of.push_back(line.substr(how.size() + 1));
  }
  ASSERT_EQ(streamed.size(), 13u);
  EXPECT_EQ(
      streamed[0],
      R"(/r1/point geometry_msgs/msg/PointStamped 100000000000 {"header":{"stamp":{"sec":100,"nanosec":5},)"
      R"("frame_id":"map"},"point":{"x":0,"y":-2,"z":0.25}})");
  EXPECT_EQ(streamed[2], R"(/r1/says std_msgs/msg/String 100500000000 {"data":"k 1"})");
  ASSERT_EQ(indexed.size(), 13u);
  EXPECT_EQ(indexed[1], streamed[2]) << "in the order of time";
  EXPECT_EQ(indexed[2], streamed[1]);
  EXPECT_EQ(indexed[12], streamed[11]);
  EXPECT_EQ(others, std::vector<std::string>{"13 2 4 100000000000 109000000000"});
}

}  // namespace
}  // namespace radioslam
