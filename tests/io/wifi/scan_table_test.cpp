#include "radioslam/io/wifi/scan_table.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

WifiLog read(const std::string& content, const ScanTableParams& params = {}) {
  const Text text = make_tool_output("scans.csv", content);
  EXPECT_TRUE(is_scan_table(text)) << content;
  return read_scan_table(text, params);
}

std::string table_of(const WifiLog& log) {
  const std::string table = format_wifi_rows(log.rows);
  return table.substr(table.find('\n') + 1);
}

TEST(ScanTable, ReadsWhatWigleExports) {
  const WifiLog log = read(
      "WigleWifi-1.6,appRelease=2.78,model=X,\"brand=Moog, LLC\",star=Sol,body=4,subBody=0\n"
      "MAC,SSID,AuthMode,FirstSeen,Channel,Frequency,RSSI,CurrentLatitude,CurrentLongitude,AltitudeMeters,"
      "AccuracyMeters,RCOIs,MfgrId,Type\n"
      "02:AA:00:00:01:00,\"a, b\",[WPA2],2019-11-22 07:18:43,6,2437,-53,1,2,3,4,,,WIFI\n"
      "02:aa:00:00:02:00,,[ESS],2019-11-22 07:18:44,36,,-71,1,2,3,4,,,WIFI\n"
      "02:aa:00:00:01:00,\"a, b\",[WPA2],2019-11-22 07:18:46,6,2437,-54,1,2,3,4,,,WIFI\n"
      "31026_1_2,x,LTE,2019-11-22 07:18:46,0,0,-90,1,2,3,4,,,LTE\n");
  EXPECT_EQ(table_of(log),
            "1574407123,02:aa:00:00:01:00,2437,-53\n1574407123,02:aa:00:00:02:00,5180,-71\n"
            "1574407126,02:aa:00:00:01:00,2437,-54\n");
  ASSERT_EQ(log.counts.size(), 2U);
  EXPECT_EQ(log.counts.begin()->second, 1U) << log.counts.begin()->first;
  EXPECT_TRUE(log.warnings.empty());
}

TEST(ScanTable, ReadsTheColumnsOfOtherApps) {
  const std::string expected = "1574407123.5,02:aa:00:00:01:00,2412,-53\n";
  for (const std::string content :
       {"time,seconds_elapsed,ssid,bssid,frequency,level,capabilities\n"
        "1574407123500000000,0.1,x,02:aa:00:00:01:00,2412,-53,[WPA]\n",
        "timestamp,bssid,ssid,frequency,level\n1574407123500,02-AA-00-00-01-00,x,2412,-53\n",
        "# Created by Network Survey\ndeviceTime,latitude,bssid,ssid,channel,frequencyMhz,signalStrength\n"
        "2019-11-22T07:18:43.5+00:00,1,02:aa:00:00:01:00,x,1,2412,-53.0\n",
        "t_s;mac_address;rssi_dbm;freq_ghz\n1574407123,5;02:aa:00:00:01:00;-53;2,412\n",
        "time_ms,mac,signal_dbm,channel\n1574407123500,02:aa:00:00:01:00,-53,1\n"})
    EXPECT_EQ(table_of(read(content)), expected) << content;
}

/// Android gives every access point the time at which it was received, in microseconds since boot.
TEST(ScanTable, RowsOfOneScanHaveOneTime) {
  const std::string content =
      "ssid,bssid,level,timestamp\nx,02:aa:00:00:01:00,-54,400627954357\nx,02:aa:00:00:02:00,-60,"
      "400628354365\n"
      "x,02:aa:00:00:01:00,-55,400628754357\nx,02:aa:00:00:02:00,-60,400631754357\n";
  EXPECT_EQ(table_of(read(content)),
            "400627.954357,02:aa:00:00:01:00,0,-54\n400627.954357,02:aa:00:00:02:00,0,-60\n"
            "400628.754357,02:aa:00:00:01:00,0,-55\n400631.754357,02:aa:00:00:02:00,0,-60\n");
  ScanTableParams each;
  each.scan_s = 0;
  each.clock_offset_s = -400000;
  EXPECT_EQ(table_of(read(content, each)).substr(0, 38), "627.954357,02:aa:00:00:01:00,0,-54\n628");
}

TEST(ScanTable, LeavesOutAndCountsWhatIsNoReading) {
  const WifiLog log = read(
      "time,bssid,level\n1,02:aa:00:00:01:00,-54\n2,02:00:00:00:00:00,-54\n3,02:aa:00:00:01:00,87\n"
      "soon,02:aa:00:00:01:00,-54\n5,elsewhere,-54\n6,02:aa:00:00:01:00,-56\n7,02:aa:00:00:01:00,-56\n");
  EXPECT_EQ(log.rows.size(), 3U);
  EXPECT_EQ(log.counts.size(), 2U);
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("2 rows are left out; the first: scans.csv:5: 'soon' is not understood"),
            std::string::npos)
      << log.warnings[0];
}

TEST(ScanTable, RefusesOtherTables) {
  const auto refused = [](const std::string& content) {
    const Text text = make_tool_output("scans.csv", content);
    EXPECT_FALSE(is_scan_table(text));
    expect_refusal([&] { read_scan_table(text, {}); }, 1, "no columns of a time, a BSSID and a level");
  };
  refused("time,bssid,strength\n1,02:aa:00:00:01:00,80\n");
  refused("time,x,y,z\n1,2,3,4\n");
  refused("time,bssid,noise_level\n1,02:aa:00:00:01:00,-90\n");
  const Text bad = make_tool_output("scans.csv", "time,bssid,level\n1,here,-50\n2,there,-50\n");
  expect_refusal([&] { read_scan_table(bad, {}); }, 2, "'here' is not a valid address");
}

}  // namespace
}  // namespace radioslam
