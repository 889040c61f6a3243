#include "radioslam/base/stamp_intervals.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

struct Message {
  int content;
  Stamp stamp;
};

TEST(MedianInterval, IsNotThatOfAGap) {
  const std::vector<Stamp> stamps{{0}, {100'000'000}, {200'000'000}, {9'000'000'000}, {9'100'000'000}};
  EXPECT_EQ(median_interval_s(stamps), 0.1);
}

TEST(MedianInterval, IsOfItemsWithStamps) {
  const std::vector<Message> messages{{1, {500}}, {2, {1500}}, {3, {2500}}};
  EXPECT_DOUBLE_EQ(median_interval_s(messages, &Message::stamp), 1e-6);
  EXPECT_DOUBLE_EQ(median_interval_s(messages, [](const Message& m) { return Stamp{m.stamp.ns / 2}; }), 5e-7);
}

TEST(MedianInterval, OfFewerThanTwoIsZero) {
  EXPECT_EQ(median_interval_s(std::vector<Stamp>{}), 0);
  EXPECT_EQ(median_interval_s(std::vector<Stamp>{{7}}), 0);
}

}  // namespace
}  // namespace radioslam
