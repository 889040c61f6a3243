#include "radioslam/io/wifi/log_time.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

// `date -u -d @1574407123 -Is` prints 2019-11-22T07:18:43+00:00.
constexpr std::int64_t kNovember_ns = 1'574'407'123'000'000'000;

TEST(PrintedTime, TakesWhatDateWrites) {
  EXPECT_EQ(parse_time_line("1574407123")->ns, kNovember_ns);
  EXPECT_EQ(parse_time_line("1574407123.123456789 ")->ns, kNovember_ns + 123'456'789);
  EXPECT_EQ(parse_time_line("12.5")->ns, 12'500'000'000);
  EXPECT_EQ(parse_time_line("2019-11-22T07:18:43+00:00")->ns, kNovember_ns);
  EXPECT_EQ(parse_time_line("2019-11-22T08:48:43,25+01:30")->ns, kNovember_ns + 250'000'000);
  EXPECT_EQ(parse_time_line("2019-11-21T23:18:43.5-0800")->ns, kNovember_ns + 500'000'000);
  EXPECT_EQ(parse_time_line("2019-11-22 07:18:43Z")->ns, kNovember_ns);
  EXPECT_EQ(parse_time_line("2020-02-29T00:00:00Z")->ns, 1'582'934'400'000'000'000);
}

TEST(PrintedTime, OtherLinesAreNotTimes) {
  for (const char* line : {"", " 12", "-1", "+1", "1e9", "1.2.3", "1574407123.", "12 s", "9999999999", "nan",
                           "2019-11-22T07:18:43", "2019-02-29T00:00:00Z", "2019-13-01T00:00:00Z",
                           "2019-11-22T07:18:43+1", "2019-11-22T07:61:43Z", "1969-12-31T23:00:00Z"})
    EXPECT_FALSE(parse_time_line(line)) << line;
}

TEST(PrintedTime, TakesWhatOtherToolsAndLocalesWrite) {
  // BusyBox and macOS do not fill in %N; the whole seconds are right.
  for (const char* line :
       {"1574407123.%N", "1574407123.N", "1574407123%N", "1574407123.3N", "15744071233N", "@1574407123",
        "1574407123000", "1574407123000000", "1574407123000000000", "Fri Nov 22 07:18:43 UTC 2019",
        "Fri Nov 22 08:18:43 CET 2019", "Fri, 22 Nov 2019 07:18:43 +0000", "Fri 22 Nov 2019 07:18:43 AM UTC",
        "Friday, November 22, 2019 7:18:43 AM GMT", "Fri Nov 22 02:18:43 EST 2019",
        "Fri Nov 22 10:18:43 +03 2019"})
    EXPECT_EQ(parse_time_line(line), Stamp{kNovember_ns}) << line;
  for (const char* line : {"1574407123,5", "1574407123500", "@1574407123.5"})
    EXPECT_EQ(parse_time_line(line), Stamp{kNovember_ns + 500'000'000}) << line;
  EXPECT_EQ(parse_time_line("Fri Nov 22 12:00:01 PM UTC 2019"), parse_time_line("2019-11-22T12:00:01Z"));
  EXPECT_EQ(parse_time_line("Fri Nov 22 12:00:01 AM UTC 2019"), parse_time_line("2019-11-22T00:00:01Z"));
}

TEST(PrintedTime, DatesWithoutAKnownZoneAreTakenAsUtcAndMarked) {
  for (const char* line :
       {"2019-11-22T07:18:43", "Fri Nov 22 07:18:43 CST 2019", "Fri Nov 22 07:18:43 2019"}) {
    const auto time = read_printed_time(line);
    ASSERT_TRUE(time) << line;
    EXPECT_FALSE(time->zone_known) << line;
    EXPECT_EQ(time->stamp, Stamp{kNovember_ns}) << line;
    EXPECT_FALSE(parse_time_line(line)) << line;
  }
}

TEST(PrintedTime, OtherLinesThatLookLikeTimesAreNotUnderstood) {
  for (const char* line :
       {"15744071231", "9999999999", "ven. 22 nov. 2019 07:18:43 CET", "07:18:43", "2019-11-22T07:18:43+1"}) {
    const auto time = read_printed_time(line);
    ASSERT_TRUE(time) << line;
    EXPECT_FALSE(time->stamp) << line;
  }
  for (const char* line : {"1574407123 s", "[1574407123.5] scan", "# 1574407123", "1574407123;5"}) {
    const auto time = read_printed_time(line);
    ASSERT_TRUE(time) << line;
    EXPECT_EQ(time->stamp, Stamp{kNovember_ns}) << line;
    EXPECT_FALSE(time->is_whole) << line;
    EXPECT_FALSE(parse_time_line(line)) << line;
  }
  for (const char* line : {"BSS 02:00:00:00:00:01(on wlan0)", "command failed: busy (-16)", "  1574407123",
                           "02:00:00:00:00:01", "x"})
    EXPECT_FALSE(read_printed_time(line)) << line;
}

TEST(PrintedTime, ClocksShowNoOthers) {
  for (const char* line : {"2024-01-01T24:00:00Z", "2024-01-01T45:00:00Z", "2024-01-01T10:60:00Z",
                           "2024-01-01T10:00:61Z", "2024-01-01T10:00:00+99:99", "2024-01-01T10:00:00-15:00",
                           "2024-01-01T10:00:00+14:01", "2024-01-01T10:00:00+01:60"})
    EXPECT_FALSE(parse_time_line(line)) << line;
  EXPECT_FALSE(parse_calendar_time("2024-01-01 45:60:60"));
  // A leap second is the first second of the next minute; time zones reach up to 14 hours.
  EXPECT_EQ(parse_time_line("2019-11-22T07:17:60Z")->ns, kNovember_ns - 43'000'000'000);
  EXPECT_EQ(parse_time_line("2019-11-22T21:18:43+14:00")->ns, kNovember_ns);
  EXPECT_TRUE(parse_calendar_time("2024-01-01 23:59:60"));
}

TEST(PrintedTime, ReadsLocalClocksAsGreenwich) {
  EXPECT_EQ(parse_calendar_time("2019-11-22 07:18:43")->ns, kNovember_ns);
  EXPECT_FALSE(parse_calendar_time("2019-11-22 07:18:43 "));
  EXPECT_FALSE(parse_calendar_time("22.11.2019 07:18:43"));
}

TEST(PrintedTime, IsFoundInNames) {
  EXPECT_EQ(time_in_name("scan-1574407123")->ns, kNovember_ns);
  EXPECT_EQ(time_in_name("scan-1574407123.5")->ns, kNovember_ns + 500'000'000);
  EXPECT_EQ(time_in_name("7_1574407123250_wlan0")->ns, kNovember_ns + 250'000'000);
  EXPECT_EQ(time_in_name("1574407123000000001")->ns, kNovember_ns + 1);
  EXPECT_FALSE(time_in_name("iw-scan1"));
  EXPECT_FALSE(time_in_name("20191122"));
  EXPECT_FALSE(time_in_name("15744071231"));
}

}  // namespace
}  // namespace radioslam
