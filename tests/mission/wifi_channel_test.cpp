#include "radioslam/mission/wifi_channel.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(WifiChannel, KnowsItsCarrier) {
  EXPECT_EQ(carrier_of_channel_hz(1), 2.412e9);
  EXPECT_EQ(carrier_of_channel_hz(13), 2.472e9);
  EXPECT_EQ(carrier_of_channel_hz(14), 2.484e9);
  EXPECT_EQ(carrier_of_channel_hz(36), 5.18e9);
  EXPECT_EQ(carrier_of_channel_hz(108), 5.54e9);
  EXPECT_EQ(carrier_of_channel_hz(177), 5.885e9);
  for (const int none : {-1, 0, 15, 31, 178}) EXPECT_FALSE(carrier_of_channel_hz(none)) << none;
}

TEST(WifiChannel, IsFoundByItsCarrier) {
  for (const int channel : {1, 13, 14, 32, 108, 177})
    EXPECT_EQ(channel_of_carrier(*carrier_of_channel_hz(channel)), channel);
  EXPECT_FALSE(channel_of_carrier(5.541e9));
  EXPECT_FALSE(channel_of_carrier(0));
}

}  // namespace
}  // namespace radioslam
