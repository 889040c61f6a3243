#include "radioslam/io/mac_address.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(MacAddressText, IsReadInEitherCaseAndEitherParting) {
  EXPECT_EQ(parse_mac_address("00:16:ea:00:00:01"), MacAddress{0x0016ea000001});
  EXPECT_EQ(parse_mac_address("FF-fe-EA-10-02-a1"), MacAddress{0xfffeea1002a1});
}

TEST(MacAddressText, IsNothingWhereItIsNoAddress) {
  for (const char* text : {"", "00:16:ea:00:00", "00:16:ea:00:00:0", "00:16:ea:00:00:001",
                           "00:16:ea:00:00:0g", "00:16-ea:00:00:01", "0016ea000001", "00:16:ea:00:00:-1",
                           "00:16:ea:00:00:01 ", "00 16 ea 00 00 01", "+0:16:ea:00:00:01"})
    EXPECT_FALSE(parse_mac_address(text)) << text;
}

TEST(MacAddressText, ReadsBackAsWritten) {
  EXPECT_EQ(to_text(MacAddress{0x0016ea00a001}), "00:16:ea:00:a0:01");
  for (const std::uint64_t value : {0x0ULL, 0xffffffffffffULL, 0x123456789abcULL})
    EXPECT_EQ(parse_mac_address(to_text(MacAddress{value})), MacAddress{value});
}

}  // namespace
}  // namespace radioslam
