#include "radioslam/team/known_logs.hpp"

#include <gtest/gtest.h>

#include <string>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

std::string keyframe(std::uint32_t number, double x_m = 1) {
  KeyframeRecord record;
  record.number = number;
  record.stamp = Stamp::from_seconds(number);
  record.T_before_this = SE3({x_m, 0, 0}, Eigen::Quaterniond::Identity());
  return encode(Record(record));
}

/// Chunks of keyframes, as the robot says them.
std::string chunks(const std::string& robot, std::uint32_t life, std::uint64_t first, std::uint64_t end,
                   double x_m = 1) {
  KnownLog log{life, {}};
  for (std::uint64_t k = 0; k < end; ++k) log.records[k] = keyframe(static_cast<std::uint32_t>(k), x_m);
  return log.bytes(robot, first, end, kMaxAgentMessageBytes).first;
}

using Extent = std::pair<std::uint32_t, std::uint64_t>;

/// Life and number of records.
Extent extent(const KnownLogs& logs, const std::string& robot) {
  const LogExtent& known = logs.extents().at(robot);
  return {known.life, known.records};
}

TEST(KnownLogs, GrowWithoutGapsHoweverRecordsCome) {
  KnownLogs logs("a", 2, 1, {});
  EXPECT_TRUE(logs.accept("b", chunks("b", 3, 4, 8)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(3, 0));
  EXPECT_EQ(logs.missing("b", 9).size(), 2U);
  EXPECT_EQ(logs.missing("b", 9).front(), std::pair(std::uint64_t{0}, std::uint64_t{3}));
  EXPECT_EQ(logs.missing("b", 9).back(), std::pair(std::uint64_t{8}, std::uint64_t{8}));
  EXPECT_TRUE(logs.accept("c", chunks("b", 3, 0, 5)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(3, 8));
  EXPECT_TRUE(logs.missing("b", 8).empty());
}

TEST(KnownLogs, OwnRecordsAreSentOnlyWhenTheyAreKept) {
  KnownLogs logs("a", 2, 1, {});
  logs.say(keyframe(0));
  EXPECT_EQ(logs.extents().at("a").records, 0U);
  const JournalChange change = logs.change();
  EXPECT_EQ(change.first_own, 0U);
  ASSERT_EQ(change.own.size(), 1U);
  logs.note_kept();
  EXPECT_EQ(logs.extents().at("a").records, 1U);
  EXPECT_TRUE(logs.change().empty());
}

TEST(KnownLogs, NobodyCanSayWhatAnotherRobotSaid) {
  KnownLogs logs("a", 2, 1, {});
  EXPECT_TRUE(logs.accept("liar", chunks("b", 3, 0, 4, 9)).empty());  // nobody has heard b
  EXPECT_TRUE(logs.accept("b", chunks("b", 3, 0, 6)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(3, 6));
  EXPECT_EQ(logs.log("b").records.at(2), keyframe(2));
  EXPECT_TRUE(logs.take_replaced().contains("b"));
  EXPECT_FALSE(logs.accept("liar", chunks("b", 3, 6, 8, 9)).empty());
  EXPECT_FALSE(logs.accept("liar", chunks("b", 4, 0, 8, 9)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(3, 6));
  EXPECT_TRUE(logs.accept("c", chunks("b", 3, 6, 8)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(3, 8));
}

TEST(KnownLogs, NobodyCanSayWhatThisRobotSaid) {
  KnownLogs logs("a", 2, 1, {});
  logs.say(keyframe(0));
  logs.note_kept();
  EXPECT_TRUE(logs.accept("b", chunks("a", 1, 0, 1)).empty());
  EXPECT_FALSE(logs.accept("b", chunks("a", 1, 0, 1, 9)).empty());
  EXPECT_FALSE(logs.accept("b", chunks("a", 1, 1, 2)).empty());
  EXPECT_EQ(extent(logs, "a"), Extent(1, 1));
}

TEST(KnownLogs, ANewLifeReplacesTheOldOneWhenTheRobotSaysIt) {
  KnownLogs logs("a", 2, 1, {});
  logs.accept("b", chunks("b", 3, 0, 6));
  logs.note_kept();
  EXPECT_FALSE(logs.accept("c", chunks("b", 4, 0, 2)).empty());
  EXPECT_EQ(logs.extents().at("b").life, 3U);
  EXPECT_TRUE(logs.accept("b", chunks("b", 4, 0, 2)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(4, 2));
  const JournalChange change = logs.change();
  EXPECT_EQ(change.forgotten, std::vector<std::string>{"b"});
  ASSERT_EQ(change.kept.size(), 1U);
  EXPECT_EQ(change.kept[0].life, 4U);
}

TEST(KnownLogs, GoOnFromWhatWasKept) {
  KnownLog own{1, {{0, keyframe(0)}, {1, keyframe(1)}}};
  KnownLog of_b{3, {{0, keyframe(0)}}};
  KnownLogs logs("a", 2, 1, {{"a", own}, {"b", of_b}});
  EXPECT_EQ(extent(logs, "a"), Extent(1, 2));
  EXPECT_EQ(extent(logs, "b"), Extent(3, 1));
  EXPECT_TRUE(logs.change().empty());
  KnownLogs anew("a", 2, 2, {{"a", own}});
  EXPECT_EQ(extent(anew, "a"), Extent(2, 0));
}

TEST(KnownLogs, ExtentsDifferWhereRecordsDo) {
  KnownLogs logs("a", 2, 1, {}), same("c", 2, 1, {}), other("d", 2, 1, {});
  logs.accept("b", chunks("b", 3, 0, 4));
  same.accept("b", chunks("b", 3, 2, 4));
  same.accept("b", chunks("b", 3, 0, 2));
  other.accept("b", chunks("b", 3, 0, 4, 9));
  EXPECT_EQ(logs.extents().at("b"), same.extents().at("b"));
  EXPECT_NE(logs.extents().at("b"), other.extents().at("b"));
}

TEST(KnownLogs, AnOlderCopyOfTheJournalIsSeen) {
  KnownLogs before("a", 2, 1, {});
  for (std::uint32_t k = 0; k < 4; ++k) before.say(keyframe(k));
  before.note_kept();
  KnownLogs logs("a", 2, 1, {{"a", {1, {{0, keyframe(0)}, {1, keyframe(1)}}}}});
  EXPECT_TRUE(logs.is_behind(before.extents().at("a")));
  for (std::uint32_t k = 2; k < 6; ++k) logs.say(keyframe(k, 9));
  logs.note_kept();
  EXPECT_TRUE(logs.is_behind(before.extents().at("a")));  // as many records, but others
  EXPECT_FALSE(logs.is_behind({1, 0, 0}));
  EXPECT_FALSE(logs.is_behind(logs.extents().at("a")));
  EXPECT_FALSE(before.is_behind({0, 9, 1}));
  logs.begin_life(2);
  EXPECT_EQ(extent(logs, "a"), Extent(2, 0));
  const JournalChange change = logs.change();
  EXPECT_EQ(change.life, 2U);
  EXPECT_EQ(change.own.size(), 6U);
  logs.note_kept();
  EXPECT_EQ(extent(logs, "a"), Extent(2, 6));
}

TEST(KnownLogs, ALogOfAnotherDimensionIsRefused) {
  KnownLogs logs("a", 2, 1, {});
  FactsRecord facts;
  facts.dimension = 3;
  facts.lidar_range_m = facts.lidar_view_rad = 1;
  const KnownLog other{3, {{0, encode(Record(facts))}}};
  EXPECT_FALSE(logs.accept("b", other.bytes("b", 0, 1, 1000).first).empty());
  EXPECT_FALSE(logs.extents().contains("b"));
}

TEST(KnownLogs, RobotsThatNobodyHeardDoNotShutOutOthers) {
  KnownLogs logs("a", 2, 1, {});
  for (std::size_t k = 0; k < 2 * kMaxTeam; ++k)
    logs.accept("liar", chunks("ghost" + std::to_string(k), 1, 0, 1));
  EXPECT_LE(logs.extents().size(), kMaxTeam);
  for (std::size_t k = 0; k < 20; ++k) {
    const std::string robot = "r" + std::to_string(k);
    EXPECT_TRUE(logs.accept(robot, chunks(robot, 1, 0, 3)).empty());
    EXPECT_EQ(logs.extents().at(robot).records, 3U);
  }
}

TEST(KnownLogs, AnOlderLifeDoesNotComeBack) {
  KnownLogs logs("a", 2, 1, {});
  logs.accept("b", chunks("b", 4, 0, 2));
  EXPECT_FALSE(logs.accept("b", chunks("b", 3, 0, 6)).empty());
  EXPECT_EQ(extent(logs, "b"), Extent(4, 2));
}

}  // namespace
}  // namespace radioslam
