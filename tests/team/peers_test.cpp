#include "radioslam/team/peers.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

/// Of a log of which nothing, or the first four records, are known.
Asking::Stretches all(const std::string&, std::uint64_t end) { return {{0, end - 1}}; }
Asking::Stretches after_four(const std::string&, std::uint64_t end) { return {{4, end - 1}}; }

std::map<std::string, Peer> two_who_know_c(double heard_s) {
  std::map<std::string, Peer> peers;
  for (const char* name : {"b", "c"}) {
    peers[name].heard = at(heard_s);
    peers[name].knows["c"] = {1, 10};
  }
  return peers;
}

TEST(ByteBudget, NeverGivesMoreThanItsRateOverAnyTime) {
  ByteBudget budget(1000);
  std::size_t sent = 0;
  budget.refill(at(0));
  for (int k = 1; k <= 100; ++k) {
    budget.refill(at(0.1 * k));
    while (budget.has(90)) {
      budget.take(90);
      sent += 90;
    }
  }
  EXPECT_LE(sent, 10000U);
  EXPECT_GE(sent, 9500U);
}

TEST(ByteBudget, LetsALargeMessagePassAtTheSameRate) {
  ByteBudget budget(1000);
  std::size_t sent = 0, messages = 0;
  budget.refill(at(0));
  for (int k = 1; k <= 1000; ++k) {
    budget.refill(at(0.1 * k));
    if (!budget.has(2500)) continue;
    budget.take(2500);
    sent += 2500;
    ++messages;
    EXPECT_FALSE(budget.has(1));
    EXPECT_LE(static_cast<double>(sent), 1000 * 0.1 * k + 2500);
  }
  EXPECT_GE(messages, 38U);
}

TEST(Asking, AsksTheRobotItselfFirstThenOthers) {
  Asking asking;
  const auto peers = two_who_know_c(0);
  const auto first = asking.wants(at(0), "a", {}, peers, all);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first.begin()->first, "c");
  EXPECT_EQ(first.begin()->second.stretches.front(), (WantedStretch{"c", 1, 0, 10}));
  EXPECT_TRUE(asking.wants(at(1), "a", {}, peers, all).empty());
  const auto second = asking.wants(at(2.5), "a", {}, two_who_know_c(2), all);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second.begin()->first, "b");
}

TEST(Asking, WaitsAsLongAsSomethingComes) {
  Asking asking;
  asking.wants(at(0), "a", {}, two_who_know_c(0), all);
  EXPECT_TRUE(asking.wants(at(1.5), "a", {{"c", {1, 4}}}, two_who_know_c(1.5), after_four).empty());
  EXPECT_TRUE(asking.wants(at(3), "a", {{"c", {1, 4}}}, two_who_know_c(3), after_four).empty());
  EXPECT_FALSE(asking.wants(at(4), "a", {{"c", {1, 4}}}, two_who_know_c(4), after_four).empty());
}

TEST(Asking, AsksForGapsAlone) {
  Asking asking;
  const auto gaps = [](const std::string&, std::uint64_t) { return Asking::Stretches{{5, 6}, {9, 9}}; };
  const auto wants = asking.wants(at(0), "a", {{"c", {1, 5}}}, two_who_know_c(0), gaps);
  ASSERT_EQ(wants.size(), 1U);
  EXPECT_EQ(wants.begin()->second.stretches, (std::vector<WantedStretch>{{"c", 1, 5, 7}, {"c", 1, 9, 10}}));
}

TEST(Asking, AsksNobodyWhoIsNotHeard) {
  Asking asking;
  EXPECT_TRUE(asking.wants(at(60), "a", {}, two_who_know_c(0), all).empty());
}

TEST(Asking, BelievesARobotAboutItsOwnLife) {
  Asking asking;
  auto peers = two_who_know_c(0);
  peers["b"].knows["c"] = {9, 1000};
  const auto wants = asking.wants(at(0), "a", {{"c", {1, 10}}}, peers, all);
  EXPECT_TRUE(wants.empty());
}

}  // namespace
}  // namespace radioslam
