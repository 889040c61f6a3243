#include "radioslam/io/text/mac_address.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(MacAddressText, ReadsBothCasesAndSeparators) {
  for (const char* text : {"00:21:6a:3f:17:5a", "00:21:6A:3F:17:5A", "00-21-6A-3f-17-5a"})
    EXPECT_EQ(parse_mac_address(text), MacAddress{0x00216a3f175a}) << text;
}

TEST(MacAddressText, RefusesEverythingElse) {
  for (const char* text :
       {"", "00:21:6a:3f:17", "00:21:6a:3f:17:5", "00:21:6a:3f:17:5a:", "00:21-6a:3f:17:5a",
        "00:21:6a:3f:17:5g", "0021:6a:3f:17:5a:", " 0:21:6a:3f:17:5a", "00 21 6a 3f 17 5a"})
    EXPECT_EQ(parse_mac_address(text), std::nullopt) << text;
}

TEST(MacAddressText, WritesWhatItReads) {
  EXPECT_EQ(format_mac_address(MacAddress{0x00216a3f175a}), "00:21:6a:3f:17:5a");
  EXPECT_EQ(parse_mac_address(format_mac_address(MacAddress{0xfedcba987654})), MacAddress{0xfedcba987654});
}

TEST(CanonicalBssid, IsOneForAllSpellingsOfAnAddress) {
  for (const char* text :
       {"00:01:6a:0f:17:5a", "00-01-6A-0F-17-5A", "0:1:6a:f:17:5a", "0001.6a0f.175a", "00016A0F175A"})
    EXPECT_EQ(canonical_bssid(text), "00:01:6a:0f:17:5a") << text;
}

TEST(CanonicalBssid, IsTheTextInLowerCaseOtherwise) {
  EXPECT_EQ(canonical_bssid("Beacon-7"), "beacon-7");
  for (const char* text : {"", "a", "aa:bb", "00:01-6a:0f:17:5a", "000:1:6a:0f:17:5a", "00:01:6a:0f:17:",
                           "00:01:6a:0f:17:5a:", "0001:6a0f:175a", "xx:01:6a:0f:17:5a", "0001.6a0f.1755a"})
    EXPECT_EQ(canonical_bssid(text), text);
}

}  // namespace
}  // namespace radioslam
