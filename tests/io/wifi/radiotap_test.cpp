#include <gtest/gtest.h>

#include "io/wifi/radiotap_bytes.hpp"
#include "radioslam/io/wifi/wifi_capture.hpp"

namespace radioslam {
namespace {

constexpr std::uint32_t kSignal = 1U << 5, kAntenna = 1U << 11, kMore = 1U << 31, kAgain = 1U << 29,
                        kVendor = 1U << 30;

TEST(Radiotap, TakesFlagsFrequencyAndLevelBehindWhatIsBefore) {
  // TSFT, flags, rate, channel, signal: aligned to 8, 1, 1, 2 and 1 bytes.
  const std::string fields = number_bytes(73872636, 8) + std::string("\x50\x02", 2) + number_bytes(2412, 2) +
                             number_bytes(0xa0, 2) + "\xd1";
  const auto header = read_radiotap(radiotap({0x2f}, fields) + "frame");
  ASSERT_TRUE(header);
  EXPECT_EQ(header->length, 8U + fields.size());
  EXPECT_EQ(header->signal_dbm, -47);
  EXPECT_EQ(header->frequency_mhz, 2412);
  EXPECT_TRUE(header->bad_checksum);
}

TEST(Radiotap, FieldsAreAlignedFromTheHeadersStart) {
  // With a second word the fields begin at 12, so TSFT begins at 16.
  const std::string fields = std::string(4, 'x') + std::string(8, 't') + "\xce" + "\xd8\x01";
  const auto header = read_radiotap(radiotap({0x21 | kMore | kAgain, kSignal | kAntenna}, fields));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->signal_dbm, -50);  // the packet's, not its antenna's -40
}

TEST(Radiotap, TakesAnAntennasLevelWhereThePacketHasNone) {
  // HE, twelve bytes aligned to two: libtins 4.0 finds no level here.
  EXPECT_EQ(read_radiotap(
                radiotap({1U << 23 | kMore | kAgain, kSignal | kAntenna}, std::string(12, 'h') + "\xce\x01"))
                ->signal_dbm,
            -50);
}

TEST(Radiotap, SkipsFieldsOfVendors) {
  // Rate, padding, the vendor's six bytes, of which the last two announce four more: libtins 4.0 finds 0 dBm
  // here.
  const std::string fields = std::string("\x02\x00\x11\x22\x33\x00\x04\x00", 8) + "vend" + "\xce";
  EXPECT_EQ(read_radiotap(radiotap({1U << 2 | kMore | kVendor, 0xff | kMore | kAgain, kSignal}, fields))
                ->signal_dbm,
            -50);
}

TEST(Radiotap, StopsAtFieldsOfUnknownSize) {
  EXPECT_FALSE(read_radiotap(radiotap({1U << 28 | kMore | kAgain, kSignal}, "\xce"))->signal_dbm);
  EXPECT_FALSE(read_radiotap(radiotap({kMore, kSignal}, "\xce"))->signal_dbm);
  EXPECT_FALSE(read_radiotap(radiotap({0}, ""))->signal_dbm);
}

TEST(Radiotap, RefusesHeadersThatDoNotFit) {
  const std::string whole = radiotap({kSignal}, "\xce");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(read_radiotap(whole.substr(0, length))) << length;
  EXPECT_FALSE(read_radiotap("\x01" + whole.substr(1)));
  EXPECT_FALSE(read_radiotap(radiotap({kSignal}, "")));
  EXPECT_FALSE(read_radiotap(radiotap({kMore | kAgain}, "")));
  EXPECT_FALSE(read_radiotap(radiotap({kMore | kVendor, 0}, std::string("\0\0\0\0\xff\xff", 6))));
}

}  // namespace
}  // namespace radioslam
