// What arrives for an agent is bounded, counted where it is left out, and of no robot's shares alone.
#include "radioslam/cli/agent/inbox.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <variant>

namespace radioslam::cli {
namespace {

TeamMessage message_of(const std::string& robot, std::size_t bytes) {
  return {robot, "a", 1, std::string(bytes, 'x')};
}

std::size_t taken_from(Inbox& inbox, const std::string& robot) {
  std::size_t count = 0;
  for (const Arrival& arrival : inbox.take(SteadyClock::now()))
    if (const auto* message = std::get_if<TeamMessage>(&arrival)) count += message->from == robot ? 1U : 0U;
  return count;
}

TEST(Inbox, CountsWhatOneRobotSendsBeyondItsShare) {
  Inbox inbox;
  for (std::size_t k = 0; k < Inbox::kMostMessages; ++k) inbox.hear(message_of("loud", 1));
  inbox.hear(message_of("b", 1));
  EXPECT_EQ(inbox.left_out().at("loud"), Inbox::kMostMessages - Inbox::kMostMessages / 4);
  EXPECT_FALSE(inbox.left_out().contains("b"));
  EXPECT_EQ(taken_from(inbox, "loud"), Inbox::kMostMessages / 4);
  inbox.hear(message_of("loud", 1));
  EXPECT_EQ(taken_from(inbox, "loud"), 1U);  // there is room again
}

TEST(Inbox, HoldsNoMoreBytesThanItsBound) {
  Inbox inbox;
  constexpr std::size_t kBytes = 60000;
  for (std::size_t k = 0; k < 2 * Inbox::kMostBytes / kBytes; ++k)
    inbox.hear(message_of("robot " + std::to_string(k % 8), kBytes));
  std::size_t bytes = 0, left_out = 0, taken = 0;
  for (const auto& [robot, count] : inbox.left_out()) left_out += count;
  for (const Arrival& arrival : inbox.take(SteadyClock::now())) {
    bytes += std::get<TeamMessage>(arrival).octets.size();
    ++taken;
  }
  EXPECT_LE(bytes, Inbox::kMostBytes);
  EXPECT_GT(bytes + kBytes, Inbox::kMostBytes);
  EXPECT_EQ(taken + left_out, 2 * Inbox::kMostBytes / kBytes);
}

TEST(Inbox, TheRobotsOwnFrontEndWaitsAndLosesNothing) {
  Inbox inbox;
  constexpr std::size_t kRecords = 3 * Inbox::kMostNews;
  std::thread front_end([&] {
    for (std::size_t k = 0; k < kRecords; ++k) {
      FrontEndNews news;
      news.records.push_back(std::to_string(k));
      inbox.push(std::move(news));
    }
  });
  std::size_t next = 0;
  while (next < kRecords) {
    const auto arrivals = inbox.take(SteadyClock::now() + std::chrono::seconds(1));
    EXPECT_LE(arrivals.size(), Inbox::kMostNews);
    for (const Arrival& arrival : arrivals)
      EXPECT_EQ(std::get<FrontEndNews>(arrival).records, std::vector{std::to_string(next++)});
  }
  front_end.join();
}

TEST(Inbox, NobodyWaitsForOneThatIsClosed) {
  Inbox inbox;
  std::thread front_end([&] {
    for (std::size_t k = 0; k < 2 * Inbox::kMostNews; ++k) inbox.push(FrontEndNews());
  });
  inbox.close();
  front_end.join();
}

}  // namespace
}  // namespace radioslam::cli
