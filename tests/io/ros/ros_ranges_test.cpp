#include "radioslam/io/ros/ros_ranges.hpp"

#include <cmath>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

WrittenMessage range_at(unsigned seconds, const std::string& topic, float range_m,
                        const std::string& frame = "", float max_m = 0, float variance = 0) {
  RosBytes bytes(MessageEncoding::kCdr);
  bytes.header(seconds, 0, frame).u8(1).f32(0).f32(0).f32(max_m).f32(range_m);
  if (variance > 0) bytes.f32(variance);
  return {topic, "sensor_msgs/Range", 7, bytes.bytes()};
}

RosRanges read(const std::vector<WrittenMessage>& messages, const RosRangeRequest& request) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.mcap", mcap_of(mcap_records(messages)));
  return read_ros_ranges(file, index_recording(file), request);
}

std::string ends_of(const RosRanges& ranges) {
  std::string ends;
  for (const RosRange& range : ranges.ranges) ends += range.i + '-' + range.j + ' ';
  return ends;
}

std::string notes_of(const RosRanges& ranges) {
  std::string notes;
  for (const std::string& warning : ranges.warnings) notes += warning + '\n';
  return notes;
}

TEST(RosRanges, AreBetweenWhomTheirTopicNames) {
  const RosRangeRequest team{{}, {{"n_3", "r3"}, {"n_7", "r1"}, {"n_9", "door"}}, {"r1", "r3"}, ""};
  const auto ranges = read(
      {range_at(2, "/uwb/tof/n_3/n_7/distance", 4.5F), range_at(1, "/r1/uwb/n_9", 3),
       range_at(3, "/uwb", 2, "r1-r3"), range_at(4, "/uwb/n_3/n_8/distance", 1), range_at(5, "/sonar", 1)},
      team);
  EXPECT_EQ(ends_of(ranges), "r1-door r3-r1 r1-r3 ") << "in the order of time";
  EXPECT_EQ(ranges.ranges[1].range_m, 4.5);
  EXPECT_EQ(ranges.ranges[1].stamp, Stamp{2'000'000'000});
  EXPECT_EQ(ranges.ranges[1].sigma_m, kUnknownRangeSigma_m);
  EXPECT_EQ(ranges.topics, (std::set<std::string>{"/r1/uwb/n_9", "/uwb", "/uwb/tof/n_3/n_7/distance"}));
  EXPECT_NE(notes_of(ranges).find("3 ranges state no sigma; 0.1 m is assumed"), std::string::npos);
  EXPECT_NE(notes_of(ranges).find("left out: /sonar (sensor_msgs/Range, 1), /uwb/n_3/n_8/distance ("),
            std::string::npos)
      << notes_of(ranges);
}

TEST(RosRanges, AreToTheRobotThatRecordedThemIfOneIsNamed) {
  const RosRangeRequest alone{{}, {}, {"a", "b"}, "a"};
  const auto ranges = read(
      {range_at(1, "/uwb/range_to_b", 3), range_at(2, "/a/sonar", 1), range_at(3, "/a/uwb/b", 3)}, alone);
  EXPECT_EQ(ends_of(ranges), "a-b a-b ");
  EXPECT_NE(notes_of(ranges).find("left out: /a/sonar"), std::string::npos) << "it names the robot itself";
}

TEST(RosRanges, AreBetweenTheStatedEnds) {
  const RosRangeRequest stated{{{"/x", {"a", "door"}}}, {}, {"a"}, ""};
  EXPECT_EQ(ends_of(read({range_at(1, "/x", 3)}, stated)), "a-door ");
}

TEST(RosRanges, ThatCannotBeOnesAreCounted) {
  const RosRangeRequest team{{}, {}, {"a", "b"}, ""};
  WrittenMessage torn = range_at(5, "/a/b", 1);
  torn.bytes.resize(20);
  const auto ranges = read(
      {range_at(1, "/a/b", 0), range_at(2, "/a/b", -1), range_at(3, "/a/b", std::nanf("")),
       range_at(4, "/a/b", 9, "", 5), range_at(0, "/a/b", 2), torn, range_at(6, "/a/b", 3, "", 5, 0.25F)},
      team);
  ASSERT_EQ(ranges.ranges.size(), 1U);
  EXPECT_EQ(ranges.ranges[0].sigma_m, 0.5) << "its variance";
  const std::string notes = notes_of(ranges);
  EXPECT_NE(notes.find("1 range is left out; the first: "), std::string::npos) << notes;
  EXPECT_NE(notes.find("4 ranges that are not positive or outside of their own limits"), std::string::npos);
  EXPECT_NE(notes.find("1 ranges have no stamp, unlike others"), std::string::npos);
}

/// A list of other nodes as LinkTrack has it, of node 1.
WrittenMessage node_frame(unsigned seconds) {
  RosBytes bytes(MessageEncoding::kCdr);
  bytes.header(seconds, 0, "").u8(2).u8(1).f32(3).f32(0).f32(0).u32(2);
  bytes.u8(2).u8(2).f32(4.5F).u8(2).u8(9).f32(6);
  return {
      "/nodes", "nlink_parser/LinktrackNodeframe2", 7, bytes.bytes(),
      "std_msgs/Header header\nuint8 MAX=3\nuint8 role  # of this node\nuint8 id\nfloat32 voltage\n"
      "float32[2] pos_3d\nLinktrackNode2[] nodes\n====\nMSG: std_msgs/Header\nbuiltin_interfaces/Time "
      "stamp\nstring frame_id\n====\nMSG: nlink_parser/LinktrackNode2\nuint8 role\nuint8 id\nfloat32 dis\n"};
}

/// A range in millimetres to an anchor, without a stamp.
WrittenMessage ranging(std::int64_t time_ns) {
  RosBytes bytes(MessageEncoding::kCdr);
  bytes.u16(9).u16(1).u32(2500).u32(0).f64(0);
  return {"/gtec", "gtec_msgs/Ranging", time_ns, bytes.bytes(),
          "int16 anchorId\nint16 tagId\nint32 range\nint32 seq\nfloat64 errorEstimation\n"};
}

TEST(RosRanges, OfUwbDriversAreReadByTheNamesOfTheirFields) {
  const RosRangeRequest team{{}, {{"1", "a"}, {"2", "b"}, {"9", "door"}}, {"a", "b"}, ""};
  const auto ranges = read({node_frame(4), ranging(5'000'000'000)}, team);
  EXPECT_EQ(ends_of(ranges), "a-b a-door a-door ");
  ASSERT_EQ(ranges.ranges.size(), 3U);
  EXPECT_EQ(ranges.ranges[0].stamp, Stamp{4'000'000'000});
  EXPECT_EQ(ranges.ranges[0].range_m, 4.5);
  EXPECT_EQ(ranges.ranges[2].range_m, 2.5) << "whole numbers are millimetres";
  EXPECT_EQ(ranges.ranges[2].stamp, Stamp{5'000'000'000});
  EXPECT_EQ(ranges.topics, (std::set<std::string>{"/gtec", "/nodes"}));
  const auto unnamed = read({node_frame(4)}, {{}, {{"1", "a"}, {"2", "b"}}, {"a", "b"}, ""});
  EXPECT_NE(notes_of(unnamed).find("1 ranges of radio 9 are left out; --name 9=ID says whose it is"),
            std::string::npos)
      << notes_of(unnamed);
}

TEST(RosRanges, OfUwbDriversWithoutAnOwnEndAreOfTheRobotThatRecordedThem) {
  WrittenMessage message = ranging(1);
  message.bytes = RosBytes(MessageEncoding::kCdr).text("b").f32(3).f32(0.25F).bytes();
  message.definition = "string to_id\nfloat32 range\nfloat32 variance\n";
  const auto ranges = read({message}, {{}, {}, {"a", "b"}, "a"});
  EXPECT_EQ(ends_of(ranges), "a-b ");
  EXPECT_EQ(ranges.ranges.at(0).sigma_m, 0.5);
}

TEST(RosRanges, ADefinitionThatIsIncompleteOrHasNoEndsIsNotOfRanges) {
  for (const char* definition : {"int32 range\n", "int32 range\nUnknown x\nint16 to_id\n", "",
                                 "float32[99999999] x\nint16 to_id\nint16 range\n"}) {
    RosTopic topic{"/x", "p/X", 1};
    topic.definition = definition;
    EXPECT_FALSE(may_have_ranges(topic)) << definition;
  }
}

}  // namespace
}  // namespace radioslam
