#include "radioslam/io/wifi/iwlist_scan.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"
#include "io/wifi/wifi_rows.hpp"

namespace radioslam {
namespace {

const std::string kIwlistHead = "wlan0     Scan completed :\n";

std::string cell(const std::string& last_byte, const std::string& lines) {
  return "          Cell 01 - Address: 02:00:00:00:00:" + last_byte + "\n" + lines;
}

WifiLog read_list(const std::string& content, const ScanListParams& params = {}) {
  const Text text = make_tool_output("iwlist.txt", content);
  return rows_of_list(text, read_iwlist_scans(text), params);
}

TEST(IwlistScan, ReadsCells) {
  const WifiLog log =
      read_list(kIwlistHead +
                cell("01",
                     "                    Channel:6\n                    Frequency:2.437 GHz (Channel 6)\n"
                     "                    Quality=58/70  Signal level=-52 dBm  \n"
                     "                    Encryption key:on\n                    ESSID:\"home\"\n"
                     "                    Extra:tsf=0000003e2b4b1a2f\n") +
                cell("0F",
                     "                    Frequency:5.18 GHz\n"
                     "                    Quality:30/70  Signal level:-80 dBm  Noise level:-95 dBm\n"));
  EXPECT_EQ(row_texts(log), (Rows{"0,02:00:00:00:00:01,2437,-52", "0,02:00:00:00:00:0f,5180,-80"}));
  EXPECT_EQ(log.counts,
            (std::map<std::string, std::size_t>{{"levels are not marked as new (':') but kept", 1}}));
}

TEST(IwlistScan, TakesTheChannelWhereThatIsAll) {
  EXPECT_EQ(row_texts(read_list(cell("01", "Channel:14\nSignal level=-52 dBm\n") +
                                cell("02", "Channel:6\nSignal level=-53 dBm\n"))),
            (Rows{"0,02:00:00:00:00:01,2484,-52", "0,02:00:00:00:00:02,2437,-53"}));
}

TEST(IwlistScan, LevelsThatAreNoDecibelsAreCounted) {
  const WifiLog log = read_list(kIwlistHead + cell("01", "Quality=58/70  Signal level=60/100\n") +
                                cell("02", "Quality=58/70\n") + cell("03", "Quality:0  Signal level:0\n") +
                                cell("04", "Quality=58/70  Signal level=-52 dBm\n"));
  EXPECT_EQ(row_texts(log), (Rows{"0,02:00:00:00:00:04,0,-52"}));
  EXPECT_EQ(log.counts.at("readings have no level in dBm and are left out"), 3U);
}

TEST(IwlistScan, LinesWithATimeAndLeftovers) {
  const std::string level = "Frequency:2.412 GHz\nSignal level=-50 dBm\n";
  const WifiLog log = read_list("100\n" + kIwlistHead + cell("01", level) +
                                "105\nlo        Interface doesn't support scanning.\n\n" + kIwlistHead +
                                cell("01", level + "Extra: Last beacon: 5100ms ago\n") +
                                cell("02", level + "Extra: Last beacon: 40ms ago\n"));
  EXPECT_EQ(row_texts(log), (Rows{"100,02:00:00:00:00:01,2412,-50", "105,02:00:00:00:00:02,2412,-50"}));
}

TEST(IwlistScan, NamesHoldAnyBytes) {
  const WifiLog log =
      read_list(kIwlistHead + cell("01", "Signal level=-52 dBm\nESSID:\"" + every_byte() +
                                             "\"\nESSID:\"Quality=1/1 Signal level=-1 dBm\"\n"));
  EXPECT_EQ(row_texts(log), (Rows{"0,02:00:00:00:00:01,0,-52"}));
}

TEST(IwlistScan, ABadCellIsLeftOutAndATimeInAnotherFormIsTaken) {
  const WifiLog log =
      read_list("1574407123.%N\n" + kIwlistHead + cell("01", "Signal level=-50 dBm\n") +
                cell("02", "  Frequency:2.4 parsec\n  Signal level=-51 dBm\n") + "15744071531 s\n" +
                kIwlistHead + cell("03", "Signal level=-52 dBm\n") + "Fri Nov 22 07:19:43 UTC 2019\n" +
                kIwlistHead + cell("04", "Signal level=-53 dBm\n"));
  EXPECT_EQ(row_texts(log),
            (Rows{"1574407123,02:00:00:00:00:01,0,-50", "1574407183,02:00:00:00:00:04,0,-53"}));
  ASSERT_EQ(log.warnings.size(), 2U);
  EXPECT_NE(log.warnings[0].find("1 cell is left out; the first: iwlist.txt:6:"), std::string::npos);
  EXPECT_NE(log.warnings[1].find("1 scan is left out; the first: iwlist.txt:8:"), std::string::npos)
      << log.warnings[1];
}

TEST(IwlistScan, RefusesMalformedInput) {
  expect_refusal([] { read_list(kIwlistHead + "wlan0     No scan results\n"); }, 0, "contains no cell");
  expect_refusal([] { read_list(kIwlistHead + cell("0g", "")); }, 2, "not a valid address");
  expect_refusal([] { read_list(cell("01", "Signal level=loud dBm\n")); }, 2, "not a valid level");
  expect_refusal([] { read_list(cell("01", "Frequency:2.4 parsec\n")); }, 2, "not a valid frequency");
  expect_refusal([] { read_list(cell("01", "Channel:six\n")); }, 2, "not a valid channel");
  expect_refusal([] { read_list(cell("01", "Extra: Last beacon: soon\n")); }, 2, "not a valid age");
  expect_refusal([] { read_list(kIwlistHead + cell("01", "") + kIwlistHead + cell("01", "")); }, 1,
                 "no time");
}

}  // namespace
}  // namespace radioslam
