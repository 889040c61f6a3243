#include "radioslam/io/text/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

TEST(ParseNumber, TakesDecimalNumbersAsAWhole) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("-2e-3"), -2e-3);
  EXPECT_EQ(parse_number("+7"), 7);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("1e+06"), 1e6);
}

TEST(ParseNumber, ReadsWhatIsTooSmallAsZero) {
  EXPECT_EQ(parse_number("1e-400"), 0);
  EXPECT_EQ(parse_number("-1e-99999999999"), 0);
  EXPECT_EQ(parse_number("." + std::string(370, '0') + "8e0000000000"), 0);
  EXPECT_EQ(parse_number("." + std::string(370, '0') + "8e10"), 0);
  EXPECT_EQ(parse_number("1e400"), std::nullopt);
  EXPECT_EQ(parse_number("1" + std::string(370, '0') + "e-10"), std::nullopt);
  EXPECT_EQ(parse_number("1e99999999999"), std::nullopt);
  EXPECT_EQ(parse_number("-0." + std::string(400, '0') + "1"), 0);
}

TEST(ParseNumber, RefusesWhatIsNoFiniteNumber) {
  for (const char* token : {"", "+", "-", ".", "nan", "NaN", "inf", "-inf", "infinity", "1e400", "1,5",
                            "1.5x", " 1", "1 ", "0x10", "+-1", "1e", "--1", "1..2"})
    EXPECT_FALSE(parse_number(token)) << token;
}

TEST(ParseId, Takes64Bits) {
  EXPECT_EQ(parse_id("6989586621679009792"), 6989586621679009792u);
  EXPECT_EQ(parse_id("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  for (const char* token : {"18446744073709551616", "-1", "1.0", "", "1e3", "a"})
    EXPECT_FALSE(parse_id(token)) << token;
}

TEST(ParseStamp, IsExactToTheNanosecond) {
  EXPECT_EQ(parse_stamp("0")->ns, 0);
  EXPECT_EQ(parse_stamp("12")->ns, 12'000'000'000);
  EXPECT_EQ(parse_stamp("1574407123.123456789")->ns, 1574407123123456789);
  EXPECT_EQ(parse_stamp("1.574407123123456789e+09")->ns, 1574407123123456789);
  EXPECT_EQ(parse_stamp("1.403636579758555412e+09")->ns, 1403636579758555412);
  EXPECT_EQ(parse_stamp("-0.1")->ns, -100'000'000);
  EXPECT_EQ(parse_stamp("15e-1")->ns, 1'500'000'000);
  EXPECT_EQ(parse_stamp(".25")->ns, 250'000'000);
  EXPECT_EQ(parse_stamp("7.")->ns, 7'000'000'000);
}

TEST(ParseStamp, RoundsFurtherDigitsToNearest) {
  EXPECT_EQ(parse_stamp("0.0000000014999")->ns, 1);
  EXPECT_EQ(parse_stamp("0.0000000015")->ns, 2);
  EXPECT_EQ(parse_stamp("0.9999999999")->ns, 1'000'000'000);
  EXPECT_EQ(parse_stamp("0.0000000005")->ns, 1);
  EXPECT_EQ(parse_stamp("1e-20")->ns, 0);
  EXPECT_EQ(parse_stamp("1e-2000000000")->ns, 0);
}

TEST(ParseStamp, RefusesWhatIsNoTimeOrDoesNotFit) {
  for (const char* token : {"", "-", ".", "nan", "inf", "1:30", "1e", "1e5000000000", "1.5s", "9223372037",
                            "1574407123123456789", "1e300", "1.2.3", "1e2000000000"})
    EXPECT_FALSE(parse_stamp(token)) << token;
}

TEST(FormatStamp, IsShortestAndReadsBack) {
  EXPECT_EQ(format_stamp({0}), "0");
  EXPECT_EQ(format_stamp({12'500'000'000}), "12.5");
  EXPECT_EQ(format_stamp({-1}), "-0.000000001");
  EXPECT_EQ(format_stamp({1574407123123456789}), "1574407123.123456789");
  Rng rng(1);
  for (int k = 0; k < 1000; ++k) {
    const Stamp stamp{static_cast<std::int64_t>(rng.next() >> 1) / (k % 2 == 0 ? 1 : -1)};
    EXPECT_EQ(parse_stamp(format_stamp(stamp)), stamp);
  }
}

TEST(FormatNumber, ReadsBackAsTheSameBits) {
  Rng rng(2);
  for (int k = 0; k < 10000; ++k) {
    const std::uint64_t bits = rng.next();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(parse_number(format_number(value)), value);
  }
  EXPECT_EQ(format_number(0.1), "0.1");
}

}  // namespace
}  // namespace radioslam
