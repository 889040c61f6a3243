#include "radioslam/io/wifi/airodump_csv.hpp"

#include <gtest/gtest.h>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/wifi/wifi_rows.hpp"

namespace radioslam {
namespace {

const std::string kNetworks =
    "\r\nBSSID, First time seen, Last time seen, channel, Speed, Privacy, Cipher, Authentication, Power, # "
    "beacons, "
    "# IV, LAN IP, ID-length, ESSID, Key\r\n";
const std::string kStations =
    "\r\nStation MAC, First time seen, Last time seen, Power, # packets, BSSID, Probed ESSIDs\r\n"
    "02:00:00:00:09:01, 2019-11-22 07:18:43, 2019-11-22 07:18:43, -34,      176, 02:00:00:00:00:01,\r\n\r\n";
const std::string kRecords =
    "LocalTime,GPSTime,ESSID,BSSID,Power,Security,Latitude,Longitude,Latitude Error,Longitude Error,Type\r\n";

std::string network(const std::string& last_byte, int power, const std::string& essid, int length) {
  return "02:00:00:00:00:" + last_byte +
         ", 2019-11-22 07:00:00, 2019-11-22 07:18:43,  6, 195, WPA2, CCMP, PSK, " + std::to_string(power) +
         ",      846,      504,   0.  0.  0.  0,  " + std::to_string(length) + ", " + essid + ", \r\n";
}

std::string network(const std::string& last_byte, int power, const std::string& essid) {
  return network(last_byte, power, essid, static_cast<int>(essid.size()));
}

std::string record(const std::string& last_byte, const char* power, const std::string& essid,
                   const char* type) {
  return "2019-11-22 07:18:43,1900-01-00 00:00:00," + essid + ",02:00:00:00:00:" + last_byte + "," + power +
         ", WPA2 ,0.000000,0.000000,0.000,0.000," + type + "\r\n";
}

WifiLog read_airodump(const std::string& content, const AirodumpParams& params = {}) {
  return read_airodump(make_tool_output("a.csv", content), params);
}

const std::string kFirst = "1574407123,02:00:00:00:00:01,2437,-50";
const std::string kSecond = "1574407123,02:00:00:00:00:0f,2437,-60";

TEST(AirodumpCsv, ReadsRadiosAndNoStations) {
  const WifiLog log = read_airodump(kNetworks + network("01", -50, "home") + network("0F", -60, "") +
                                    network("02", -1, "far") + kStations);
  EXPECT_EQ(row_texts(log), (Rows{kFirst, kSecond}));
  EXPECT_EQ(log.counts.at("rows have no power and are left out"), 1U);
  EXPECT_TRUE(log.warnings.empty());
}

TEST(AirodumpCsv, NamesHoldCommasAndLineEnds) {
  const std::string all = every_byte();
  for (std::size_t begin = 0; begin < all.size(); begin += 32) {
    const std::string name = all.substr(begin, 32);
    EXPECT_EQ(row_texts(read_airodump(kNetworks + network("01", -50, name) +
                                      network("0F", -60, "a, b\r\n, c") + kStations)),
              (Rows{kFirst, kSecond}))
        << begin;
    EXPECT_EQ(row_texts(read_airodump(kRecords + record("01", "-50", name, "AP") +
                                      record("0F", "-60", "a,b\r\n,c", "AP")))
                  .size(),
              2U)
        << begin;
  }
}

TEST(AirodumpCsv, EscapedNamesAreLongerThanStated) {
  EXPECT_EQ(row_texts(read_airodump(kNetworks + network("01", -50, "\\x01\\x02\\,", 3) +
                                    network("0F", -60, "\" a\"", 2))),
            (Rows{kFirst, kSecond}));
}

TEST(AirodumpCsv, ReadsRecordsOfAccessPoints) {
  EXPECT_EQ(row_texts(read_airodump(kRecords + record("01", "-50", "home", "AP") +
                                    record("07", "-33", "", "Client") + record("01", "-1", "home", "AP") +
                                    record("0F", "-60", "a,b", "AP"))),
            (Rows{"1574407123,02:00:00:00:00:01,0,-50", "1574407123,02:00:00:00:00:0f,0,-60"}));
}

TEST(AirodumpCsv, LocalTimesAreBroughtToOurClock) {
  AirodumpParams params;
  params.utc_offset_h = -8;
  params.clock_offset_s = 0.5;
  EXPECT_EQ(read_airodump(kNetworks + network("01", -50, ""), params).rows.at(0).stamp.ns,
            1'574'435'923'500'000'000);
}

TEST(AirodumpCsv, TheFilesEndMayCutARow) {
  const std::string whole = kNetworks + network("01", -50, "home") + network("0F", -60, "home");
  const std::size_t first = kNetworks.size() + network("01", -50, "home").size();
  for (std::size_t length = first; length < whole.size(); ++length) {
    const WifiLog log = read_airodump(whole.substr(0, length));
    ASSERT_GE(log.rows.size(), 1U) << length;
    EXPECT_EQ(row_texts(log).back(), log.rows.size() == 1 ? kFirst : kSecond);
  }
  const std::string records = kRecords + record("01", "-50", "home", "AP");
  EXPECT_EQ(read_airodump(records + "2019-11-22 07:18:43,1900-01").warnings.size(), 1U);
}

TEST(AirodumpCsv, RefusesMalformedInput) {
  expect_refusal([] { read_airodump("BSSID\n"); }, 1, "neither the header");
  expect_refusal([] { read_airodump("\r\n\r\n"); }, 2, "neither the header");
  expect_refusal([] { read_airodump(kNetworks + "02:00:00:00:00:01, 2019\r\nx\r\n"); }, 3,
                 "ends before its ESSID");
  expect_refusal([] { read_airodump(kNetworks + network("0g", -50, "a\nb") + network("0g", -50, "")); }, 3,
                 "not a valid BSSID");
  expect_refusal([] { read_airodump(kNetworks + "02:00:00:00:00:01,,now,1,,,,,-5,,,,0,,\r\n"); }, 3,
                 "'now' is not a valid time");
  expect_refusal(
      [] { read_airodump(kNetworks + "02:00:00:00:00:01,,2019-11-22 07:18:43,1,,,,,loud,,,,0,,\r\n"); }, 3,
      "not a valid power");
  expect_refusal(
      [] { read_airodump(kNetworks + "02:00:00:00:00:01,,2019-11-22 07:18:43,x,,,,,-5,,,,0,,\r\n"); }, 3,
      "not a valid channel");
  expect_refusal(
      [] { read_airodump(kNetworks + "02:00:00:00:00:01,,2019-11-22 07:18:43,1,,,,,-5,,,,long,,\r\n"); }, 3,
      "not a valid ID-length");
  expect_refusal([] { read_airodump(kRecords + "what\r\n\r\n"); }, 2, "not a row of airodump's log");
}

TEST(AirodumpCsv, ABadRowIsLeftOutCountedAndNamed) {
  const auto warning_of = [](const std::string& content) {
    const WifiLog log = read_airodump(content);
    EXPECT_EQ(log.rows.size(), 2U) << content;
    return log.warnings.size() == 1 ? log.warnings.front() : "not one warning";
  };
  const std::string bad_time = "02:00:00:00:00:05,,now,1,,,,,-5,,,,0,,\r\n";
  EXPECT_NE(warning_of(kNetworks + network("01", -50, "a\nb") + bad_time + network("0F", -60, ""))
                .find("1 row is left out; the first: "),
            std::string::npos);
  EXPECT_NE(
      warning_of(kNetworks + network("01", -50, "") + network("0g", -50, "a\nb") + network("0F", -60, ""))
          .find("not a valid BSSID"),
      std::string::npos);
  EXPECT_NE(warning_of(kRecords + record("01", "-5", "", "AP") + "what\r\n" + record("01", "-5", "", "AP"))
                .find(":3: not a row of airodump's log"),
            std::string::npos);
}

TEST(AirodumpCsv, ReadsRecordedRows) {
  RADIOSLAM_RECORDED(path, "wifi_captures/airodump_excerpt.csv");
  EXPECT_EQ(row_texts(join_wifi_logs({read_airodump(read_tool_output(path), {})})),
            (Rows{"1577385424,02:1a:11:ff:d9:bd,2462,-43", "1667065905,16:27:f5:d0:e9:7a,2432,-81",
                  "1667065907,78:98:e8:03:3e:22,2412,-61", "1690545050,be:f1:71:d5:17:8b,2412,-30",
                  "1690545211,9a:75:a8:b9:04:1e,2412,-68", "1690545312,6e:c7:ec:16:da:1a,2412,-30"}));
}

}  // namespace
}  // namespace radioslam
