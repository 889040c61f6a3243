#include "radioslam/io/live/live_address.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

TEST(LiveAddress, IsAPortOfThisMachineOrAnAddressWithOne) {
  EXPECT_EQ(parse_live_address("8080"), (LiveAddress{"127.0.0.1", 8080}));
  EXPECT_EQ(parse_live_address("0.0.0.0:80"), (LiveAddress{"0.0.0.0", 80}));
  EXPECT_EQ(parse_live_address("robot.local:65535"), (LiveAddress{"robot.local", 65535}));
  EXPECT_EQ(parse_live_address("[::1]:8080"), (LiveAddress{"::1", 8080}));
  for (const char* wrong : {"", "x", "-1", "65536", "80x", ":80", "a:", "::1", "::1:80", "[]:80", "1.5"})
    expect_refusal([&] { parse_live_address(wrong); }, 0, "is no PORT");
}

TEST(LiveAddress, KnowsWhatIsThisMachineAlone) {
  for (const char* alone : {"8080", "127.0.0.1:1", "127.8.0.1:1", "localhost:1", "[::1]:1"})
    EXPECT_TRUE(is_loopback(parse_live_address(alone).host)) << alone;
  for (const char* reached : {"0.0.0.0:1", "[::]:1", "10.0.0.1:1", "robot:1", "127.0.0.1.robot:1"})
    EXPECT_FALSE(is_loopback(parse_live_address(reached).host)) << reached;
}

TEST(LiveAddress, IsAUrl) {
  EXPECT_EQ(url_of({"127.0.0.1", 8080}, ""), "http://127.0.0.1:8080/");
  EXPECT_EQ(url_of({"::1", 8080}, "ab"), "http://[::1]:8080/?token=ab");
}

TEST(LiveAddress, RefusesAnAddressThatThisMachineDoesNotHave) {
  expect_refusal(
      [] {
        refuse_unusable({"203.0.113.1", 8080});
      },
      0, "203.0.113.1:8080: this machine does not have that address");
  EXPECT_NO_THROW(refuse_unusable({"127.0.0.1", 0}));
}

TEST(LiveAddress, DrawsTokensThatDiffer) {
  EXPECT_EQ(drawn_token().size(), 32u);
  EXPECT_NE(drawn_token(), drawn_token());
}

TEST(LiveAddress, HasATokenWhereOthersReachIt) {
  EXPECT_EQ(token_of({"127.0.0.1", 1}, ""), "");
  EXPECT_EQ(token_of({"127.0.0.1", 1}, "a.B_~-9"), "a.B_~-9");
  EXPECT_EQ(token_of({"0.0.0.0", 1}, "").size(), 32u);
  EXPECT_EQ(token_of({"0.0.0.0", 1}, "x"), "x");
  for (const char* odd : {"a b", "a&b", "\xc3\xa4", "<", "\n"})
    expect_refusal([&] { token_of({"0.0.0.0", 1}, odd); }, 0, "a token consists of");
}

}  // namespace
}  // namespace radioslam
