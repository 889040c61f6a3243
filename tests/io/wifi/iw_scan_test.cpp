#include "radioslam/io/wifi/iw_scan.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/wifi/wifi_rows.hpp"

namespace radioslam {
namespace {

std::string bss(const std::string& last_byte, const std::string& signal, const std::string& more = {}) {
  return "BSS 02:00:00:00:00:" + last_byte + "(on wlan0)\n\tfreq: 2412\n\tsignal: " + signal + "\n" + more;
}

WifiLog read_scan(const std::string& content, const ScanListParams& params = {}) {
  const Text text = make_tool_output("scan.txt", content);
  return rows_of_list(text, read_iw_scans(text), params);
}

std::string age(int ms) { return "\tlast seen: " + std::to_string(ms) + " ms ago\n"; }

TEST(IwScan, TakesHundredthsAsIwPrintsThem) {
  EXPECT_EQ(
      row_texts(read_scan(bss("01", "-53.00 dBm") + bss("02", "-53.-50 dBm") + bss("03", "0.-50 dBm") +
                          bss("04", "-53.-05 dBm") + bss("05", "-90 dBm"))),
      (Rows{"0,02:00:00:00:00:01,2412,-53", "0,02:00:00:00:00:02,2412,-53.5", "0,02:00:00:00:00:03,2412,-0.5",
            "0,02:00:00:00:00:04,2412,-53.05", "0,02:00:00:00:00:05,2412,-90"}));
}

TEST(IwScan, LinesWithATimeBeginScans) {
  EXPECT_EQ(row_texts(read_scan("100.5\n" + bss("01", "-53.00 dBm") +
                                "command failed: Device or resource busy\n"
                                "104\n" +
                                bss("0A", "-60.00 dBm") + bss("01", "-54.00 dBm"))),
            (Rows{"100.5,02:00:00:00:00:01,2412,-53", "104,02:00:00:00:00:0a,2412,-60",
                  "104,02:00:00:00:00:01,2412,-54"}));
}

TEST(IwScan, StaleReadingsAreLeftOutOrKeptAtTheirTime) {
  const std::string log = "100\n" + bss("01", "-53.00 dBm", age(200)) + "104\n" +
                          bss("01", "-53.00 dBm", age(4200)) + bss("02", "-60.00 dBm", age(3900));
  const WifiLog left_out = read_scan(log);
  EXPECT_EQ(row_texts(left_out), (Rows{"100,02:00:00:00:00:01,2412,-53", "104,02:00:00:00:00:02,2412,-60"}));
  EXPECT_EQ(left_out.counts.size(), 1U);
  ScanListParams params;
  params.keep_stale = true;
  EXPECT_EQ(row_texts(read_scan(log, params)),
            (Rows{"99.8,02:00:00:00:00:01,2412,-53", "100,02:00:00:00:00:01,2412,-53",
                  "104,02:00:00:00:00:02,2412,-60"}));
}

TEST(IwScan, AnEmptyScanLeavesNoStaleReadings) {
  const WifiLog log = read_scan("100\n" + bss("01", "-53.00 dBm", age(100)) + "104\n108\n" +
                                bss("02", "-60.00 dBm", age(4500)));
  EXPECT_EQ(log.rows.size(), 2U);  // the second reading was not in an earlier list
  EXPECT_EQ(log.counts.at("scans are empty"), 1U);
}

TEST(IwScan, TheBootClockTimesAndSeparatesScansWithoutOthers) {
  const auto heard = [](const char* boot_s, int ms) {
    return std::string("\tlast seen: ") + boot_s + "s [boottime]\n" + age(ms);
  };
  EXPECT_EQ(row_texts(read_scan(bss("01", "-53.00 dBm", heard("4206.107", 1410)) +
                                bss("02", "-54.00 dBm", heard("4207.500", 20)) +
                                bss("01", "-55.00 dBm", heard("4210.000", 500)))),
            (Rows{"4207.517,02:00:00:00:00:01,2412,-53", "4207.517,02:00:00:00:00:02,2412,-54",
                  "4210.5,02:00:00:00:00:01,2412,-55"}));
}

TEST(IwScan, NamesHoldAnyBytes) {
  const WifiLog log =
      read_scan(bss("01", "-53.00 dBm", "\tSSID: " + every_byte() + "\n\tSSID: signal: -1.00 dBm\n") +
                bss("02", "-60.00 dBm"));
  EXPECT_EQ(log.rows.size(), 2U);
}

TEST(IwScan, LevelsThatAreNoDecibelsAreCounted) {
  const WifiLog log = read_scan(bss("01", "70/100") + "BSS 02:00:00:00:00:02(on wlan0)\n\tfreq: 5180.0\n" +
                                bss("03", "-60.00 dBm"));
  EXPECT_EQ(log.rows.size(), 1U);
  EXPECT_EQ(log.counts.at("readings have no level in dBm and are left out"), 2U);
}

TEST(IwScan, TheFilesEndMayCutALine) {
  const std::string whole = bss("01", "-53.00 dBm") + bss("02", "-61.50 dBm", age(1234));
  const std::size_t first = bss("01", "-53.00 dBm").size();
  for (std::size_t length = first; length < whole.size(); ++length) {
    const WifiLog log = read_scan(whole.substr(0, length));
    ASSERT_GE(log.rows.size(), 1U) << length;
    if (log.rows.size() > 1) {
      EXPECT_EQ(row_texts(log)[1], "0,02:00:00:00:00:02,2412,-61.5") << length;
    }
  }
}

TEST(IwScan, RefusesMalformedInput) {
  expect_refusal([] { read_scan("wlan0 (phy #0)\n"); }, 0, "contains no BSS");
  expect_refusal([] { read_scan("BSS of my neighbour\n"); }, 1, "'of' is not a valid address");
  expect_refusal([] { read_scan(bss("01", "loud")); }, 3, "not a valid signal");
  expect_refusal([] { read_scan(bss("01", "-5x.00 dBm")); }, 3, "not a valid signal");
  expect_refusal([] { read_scan(bss("01", "-50.00 dBm", "\tsignal: -60.00 dBm\n")); }, 4, "second signal");
  expect_refusal([] { read_scan(bss("01", "-50.00 dBm", "\tfreq: 1\n")); }, 4, "second frequency");
  expect_refusal([] { read_scan("BSS 02:00:00:00:00:01\n\tfreq: \xff\n"); }, 2,
                 "'?' is not a valid frequency");
  expect_refusal([] { read_scan(bss("01", "-50.00 dBm", "\tlast seen: -3 ms ago\n")); }, 4,
                 "not a valid 'last seen' time");
}

TEST(IwScan, ABadRadioIsLeftOutCountedAndNamed) {
  const std::string good = bss("01", "-50.00 dBm");
  for (const std::string& bad : {std::string("BSS of my neighbour\n\tfreq: 2412\n"), bss("02", "loud"),
                                 bss("02", "-60.00 dBm", "\tfreq: 1\n")}) {
    const WifiLog log = read_scan(bad + good + good.substr(0, good.size() - 1) + "\n");
    EXPECT_EQ(log.rows.size(), 2U) << bad;
    ASSERT_FALSE(log.warnings.empty()) << bad;
    EXPECT_NE(log.warnings.front().find("scan.txt: 1 radio is left out; the first: scan.txt:"),
              std::string::npos)
        << log.warnings.front();
  }
}

TEST(IwScan, ScansAreTimedByWhateverDatePrints) {
  for (const auto& [first, second] :
       {std::pair("1574407123.%N", "1574407153.%N"), std::pair("@1574407123", "@1574407153"),
        std::pair("1574407123000", "1574407153000")})
    EXPECT_EQ(row_texts(read_scan(first + std::string("\n") + bss("01", "-50.00 dBm") + second + "\n" +
                                  bss("02", "-51.00 dBm"))),
              (Rows{"1574407123,02:00:00:00:00:01,2412,-50", "1574407153,02:00:00:00:00:02,2412,-51"}));
}

TEST(IwScan, AScanWhoseTimeIsNotUnderstoodIsLeftOutAndNamed) {
  const WifiLog log = read_scan("100\n" + bss("01", "-50.00 dBm") + "15744071231 seconds\n" +
                                bss("02", "-50.00 dBm") + "104\n" + bss("03", "-50.00 dBm"));
  EXPECT_EQ(row_texts(log), (Rows{"100,02:00:00:00:00:01,2412,-50", "104,02:00:00:00:00:03,2412,-50"}));
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("scan.txt:5: '15744071231 seconds' is not understood as a time"),
            std::string::npos)
      << log.warnings[0];
  expect_refusal([] { read_scan("15744071231 seconds\n" + bss("01", "-50.00 dBm")); }, 1,
                 "is not understood as a time");
}

TEST(IwScan, OfATimeWithSomethingBehindItTheSecondsCountAndTheLineIsNamed) {
  const WifiLog log =
      read_scan("1574407123 s\n" + bss("01", "-50.00 dBm") + "1574407153 s\n" + bss("02", "-50.00 dBm"));
  EXPECT_EQ(row_texts(log),
            (Rows{"1574407123,02:00:00:00:00:01,2412,-50", "1574407153,02:00:00:00:00:02,2412,-50"}));
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_EQ(log.warnings[0], "scan.txt:1: '1574407123 s' is not understood, nor are 1 other lines");
  EXPECT_EQ(log.counts.size(), 1U);
}

TEST(IwScan, AListBeforeTheFirstTimeIsLeftOut) {
  const WifiLog log = read_scan(bss("01", "-50.00 dBm") + "100\n" + bss("01", "-50.00 dBm"));
  EXPECT_EQ(log.rows.size(), 1U);
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("scan.txt:1: this scan has no time"), std::string::npos);
}

TEST(IwScan, NamesALineOutsideAllRadios) {
  const WifiLog log = read_scan("100\nsudo: unable to resolve host\n" + bss("01", "-50.00 dBm"));
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("scan.txt:2: 'sudo: unable to resolve host' is not understood"),
            std::string::npos);
}

/// From the second radio on, jc 1.22 prefixes names with the last heading of the previous radio
/// ("config_methods_signal": "-70.00 dBm"), and leaves their values as printed.
double value_of_jc(const nlohmann::json& radio, const std::string& name, const std::string& plain) {
  if (radio.contains(plain)) return radio[plain].get<double>();
  for (const auto& [key, value] : radio.items())
    if (key.ends_with("_" + name))
      return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
  ADD_FAILURE() << "jc has no " << name;
  return 0;
}

TEST(IwScan, EqualsJcsParserOnRecordedScans) {
  RADIOSLAM_RECORDED(folder, "wifi_captures/jc");
  for (const auto& [name, expected] :
       {std::pair("iw-scan0", 2U), std::pair("iw-scan1", 26U), std::pair("iw-scan2", 1U)}) {
    const Text text = read_tool_output(folder / (std::string(name) + ".out"));
    const WifiLog log = rows_of_list(text, read_iw_scans(text));
    const auto referee = nlohmann::json::parse(read_bytes(folder / (std::string(name) + ".json")));
    ASSERT_EQ(log.rows.size(), expected);
    ASSERT_EQ(referee.size(), expected);
    for (std::size_t k = 0; k < expected; ++k) {
      EXPECT_EQ(log.rows[k].bssid, referee[k]["bssid"].get<std::string>());
      EXPECT_EQ(static_cast<double>(log.rows[k].frequency_mhz), value_of_jc(referee[k], "freq", "freq"));
      EXPECT_EQ(static_cast<double>(log.rows[k].rssi_dbm), value_of_jc(referee[k], "signal", "signal_dbm"));
    }
  }
}

}  // namespace
}  // namespace radioslam
