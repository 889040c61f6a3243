#include "radioslam/io/wifi/nmcli_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "io/refusal.hpp"
#include "io/wifi/wifi_rows.hpp"

namespace radioslam {
namespace {

const std::string kAddress = "02\\:00\\:00\\:00\\:00\\:0";

WifiLog read_nmcli(const std::string& content,
                   const std::vector<std::string>& fields = default_nmcli_fields()) {
  const Text text = make_tool_output("nmcli.txt", content);
  return rows_of_list(text, read_nmcli_lists(text, fields));
}

/// NetworkManager's conversion of a level in dBm (version 1.42, src/core/nm-core-utils.c).
int signal_of(int dbm) {
  const int below = std::abs(std::clamp(dbm, -100, -40) + 40);
  return 100 - static_cast<int>(100.0 * below / 60.0);
}

TEST(NmcliList, UndoesTheSignalOfEveryLevel) {
  for (int dbm = -100; dbm <= -40; ++dbm) {
    EXPECT_EQ(level_of_nmcli_signal(signal_of(dbm)).rssi_dbm, dbm);
    EXPECT_TRUE(level_of_nmcli_signal(signal_of(dbm)).exact);
  }
}

TEST(NmcliList, OtherSignalsAreOnTheSameLine) {
  std::set<int> made;
  for (int dbm = -100; dbm <= -40; ++dbm) made.insert(signal_of(dbm));
  for (int signal = 0; signal <= 100; ++signal) {
    const NmcliLevel level = level_of_nmcli_signal(signal);
    EXPECT_EQ(level.exact, made.contains(signal)) << signal;
    EXPECT_NEAR(level.rssi_dbm, -100 + 0.6 * signal, 0.6) << signal;
  }
}

TEST(NmcliList, ReadsEscapedRows) {
  const WifiLog log =
      read_nmcli("1574407123.5\n" + kAddress + "1:686F6D65:6:2437 MHz:82\n" + kAddress +
                 "2::36:5180 MHz:100\n\n1574407128\n" + kAddress + "1:686F6D65:6:2437 MHz:80\n");
  EXPECT_EQ(row_texts(log),
            (Rows{"1574407123.5,02:00:00:00:00:01,2437,-51", "1574407123.5,02:00:00:00:00:02,5180,-40",
                  "1574407128,02:00:00:00:00:01,2437,-52"}));
  EXPECT_EQ(log.counts.size(), 1U);  // clipped
}

TEST(NmcliList, OtherFieldsInAnotherOrderAndAnyName) {
  std::string name = every_byte();
  std::erase(name, '\n');
  std::string escaped;
  for (const char c : name) escaped += c == ':' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  EXPECT_EQ(row_texts(read_nmcli("*:82:" + escaped + ":11:" + kAddress + "1\r\n",
                                 parse_nmcli_fields("in-use,signal,SSID,chan,BSSID"))),
            (Rows{"0,02:00:00:00:00:01,2462,-51"}));
}

TEST(NmcliList, RefusesMalformedInput) {
  expect_refusal([] { read_nmcli("100\n"); }, 0, "contains no row");
  expect_refusal([] { read_nmcli("Error: NetworkManager is not running.\n"); }, 1,
                 "2 fields, but --fields names 5");
  expect_refusal([] { read_nmcli("home:686F6D65:6:2437 MHz:82\n"); }, 1, "not a valid BSSID");
  expect_refusal([] { read_nmcli(kAddress + "1:686F6D65:6:2437 MHz:101\n"); }, 1, "not a SIGNAL");
  expect_refusal([] { read_nmcli(kAddress + "1:686F6D65:6:2437 m:82\n"); }, 1, "not a FREQ");
  expect_refusal(
      [] {
        read_nmcli(kAddress + "1:82:x\n", {"BSSID", "SIGNAL", "CHAN"});
      },
      1, "not a valid CHAN");
  expect_refusal([] { parse_nmcli_fields("BSSID,CHAN"); }, 0, "SIGNAL must appear exactly once");
  expect_refusal([] { parse_nmcli_fields("BSSID,SIGNAL,BSSID"); }, 0, "BSSID must appear exactly once");
}

const std::string kTable =
    "IN-USE  BSSID              SSID                      MODE   CHAN  RATE        SIGNAL  BARS  SECURITY \n"
    "*       02:00:00:00:00:01  The 5 65 Mbit/s 7 of us   Infra  11    65 Mbit/s   49      __    WPA2 \n"
    "        02:00:00:00:00:02  --                        Infra  36    270 Mbit/s  80      ____  WPA1 WPA2 "
    "\n";

TEST(NmcliList, ReadsTheTableForPeopleInAnyLanguage) {
  const Rows rows{"100,02:00:00:00:00:01,2462,-71", "100,02:00:00:00:00:02,5180,-52"};
  EXPECT_EQ(row_texts(read_nmcli("100\n" + kTable)), rows);
  EXPECT_EQ(row_texts(read_nmcli(
                "100\nEN USO  BSSID              SSID  MODO   CANAL  TASA        SE\xc3\x91"
                "AL  BARRAS  SEGURIDAD\n"
                "*       02:00:00:00:00:01  Casa  Infra  11     65 Mbit/s   49     \xe2\x96\x82___    WPA2\n"
                "        02:00:00:00:00:02  Casa  Infra  36     270 "
                "\xd0\x9c\xd0\xb1\xd0\xb8\xd1\x82/\xd1\x81  80     ____    --\n")),
            rows);
  EXPECT_EQ(row_texts(read_nmcli("SSID BSSID MODE FREQ RATE SIGNAL SECURITY\n"
                                 "'a b' 02:00:00:00:00:02 Infrastructure 5180 MHz 54 MB/s 80 WPA2\n")),
            (Rows{"0,02:00:00:00:00:02,5180,-52"}));
}

TEST(NmcliList, ATableForPeopleWithoutWhatIsNeededNamesTheCommand) {
  for (const char* table : {"IN-USE  SSID  MODE   CHAN  RATE       SIGNAL  BARS  SECURITY\n"
                            "*       home  Infra  11    65 Mbit/s  49      __    WPA2\n",
                            "BSSID              SIGNAL\n02:00:00:00:00:01  49\n"})
    expect_refusal([&] { read_nmcli(table); }, 2,
                   "`nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list`");
}

TEST(NmcliList, ABadRowIsLeftOutCountedAndNamed) {
  const WifiLog log = read_nmcli("1574407123.%N\n" + kAddress + "1:::0:50\nError: busy\n" + kAddress +
                                 "2:::0:50\n1574407153.%N\n" + kAddress + "1:::0:50\n");
  EXPECT_EQ(log.rows.size(), 3U);
  EXPECT_EQ(log.rows.back().stamp.ns, 1'574'407'153'000'000'000);
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("1 row is left out; the first: nmcli.txt:3:"), std::string::npos);
}

}  // namespace
}  // namespace radioslam
