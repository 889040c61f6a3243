#include "radioslam/io/live/live_feed.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

constexpr std::chrono::milliseconds kNow{0};

LiveText text(const std::string& words) { return std::make_shared<const std::string>(words); }

/// Publishes the change "n" and, where somebody waits for it, the whole "1..n".
void publish(LiveFeed& feed, int n) {
  feed.publish(text(std::to_string(n)), feed.needs_whole() ? text("1.." + std::to_string(n)) : nullptr);
}

/// All that is there for a reader.
std::string read(LiveFeed::Reader& reader) {
  std::string all;
  while (const LiveText next = reader.next(kNow)) all += *next + ' ';
  return all;
}

TEST(LiveFeed, GivesTheWholeAndThenWhatChanges) {
  LiveFeed feed;
  publish(feed, 1);
  EXPECT_FALSE(feed.is_read());
  LiveFeed::Reader reader(feed);
  EXPECT_TRUE(feed.is_read());
  EXPECT_EQ(read(reader), "") << "nobody asked for the whole so far";
  publish(feed, 2);
  EXPECT_EQ(read(reader), "1..2 ");
  EXPECT_FALSE(feed.needs_whole());
  publish(feed, 3);
  publish(feed, 4);
  EXPECT_EQ(read(reader), "3 4 ");
}

TEST(LiveFeed, GivesASecondReaderAWholeThatIsNotOld) {
  LiveFeed feed;
  LiveFeed::Reader first(feed);
  publish(feed, 1);
  EXPECT_EQ(read(first), "1..1 ");
  publish(feed, 2);
  LiveFeed::Reader second(feed);
  EXPECT_EQ(read(second), "1..1 2 ");
  for (int n = 3; n < 20; ++n) publish(feed, n);
  LiveFeed::Reader third(feed);
  EXPECT_EQ(read(third), "");
  publish(feed, 20);
  EXPECT_EQ(read(third), "1..20 ");
}

TEST(LiveFeed, GivesTheWholeAgainToAReaderThatFellBehind) {
  LiveFeed feed;
  LiveFeed::Reader reader(feed);
  publish(feed, 1);
  EXPECT_EQ(read(reader), "1..1 ");
  for (int n = 2; n < 20; ++n) publish(feed, n);
  EXPECT_EQ(read(reader), "");
  EXPECT_TRUE(feed.needs_whole());
  publish(feed, 20);
  EXPECT_EQ(read(reader), "1..20 ");
}

TEST(LiveFeed, EndsForEveryReader) {
  LiveFeed feed;
  LiveFeed::Reader reader(feed), newcomer(feed);
  publish(feed, 1);
  feed.end(text("end"));
  EXPECT_FALSE(reader.is_over());
  EXPECT_EQ(read(reader), "1..1 end ");
  EXPECT_TRUE(reader.is_over());
  EXPECT_EQ(read(reader), "");
  EXPECT_EQ(read(newcomer), "1..1 end ");
}

TEST(LiveFeed, CountsReadersThatLeaveBeforeTheyHadAnything) {
  LiveFeed feed;
  { const LiveFeed::Reader reader(feed); }
  EXPECT_FALSE(feed.needs_whole());
  EXPECT_FALSE(feed.is_read());
}

}  // namespace
}  // namespace radioslam
