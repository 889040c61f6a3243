// radioslam import iw, iwlist, nmcli, airodump, pcap: output of WiFi tools becomes a robot's wifi.csv.
#include <gtest/gtest.h>

#include <chrono>

#include "cli/import_fixture.hpp"

namespace radioslam::cli {
namespace {

const std::string kScan =
    "BSS 02:00:00:00:01:00(on wlan0)\n\tfreq: 2412\n\tsignal: -53.-50 dBm\n\tlast seen: 120 ms ago\n"
    "BSS 02:00:00:00:02:00(on wlan0)\n\tfreq: 5180\n\tsignal: -60.00 dBm\n\tlast seen: 2000 ms ago\n";
const std::string kTable =
    "t_s,bssid,frequency_mhz,rssi_dbm\n0,02:00:00:00:01:00,2412,-53.5\n0,02:00:00:00:02:00,5180,-60\n";

struct ImportWifi : ImportFixture {
  void SetUp() override { write_file(folder.path() / "scan.txt", kScan); }
  /// A mission of robots a and b.
  void make_team() const {
    for (const char* id : {"a", "b"}) {
      std::filesystem::create_directories(folder.path() / "m/robots" / id);
      write_file(folder.path() / "m/robots" / id / "odometry.tum", "0 0 0 0 0 0 0 1\n9 2 0 0 0 0 0 1\n");
    }
    write_file(folder.path() / "m/mission.yaml",
               "format: radioslam-mission/1\nname: m\ndimension: 2\nrobots:\n  a: {}\n  b: {}\n");
  }
};

TEST_F(ImportWifi, WritesATableAlone) {
  const Outcome outcome = import({"iw", "scan.txt", "-o", "wifi.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_file(folder.path() / "wifi.csv"), kTable);
  EXPECT_EQ(outcome.out, "wifi.csv: 2 rows, 1 scans, 2 radios\n");
}

TEST_F(ImportWifi, GivesAMissionsRobotItsTableAndKeepsTheRest) {
  make_team();
  const Outcome outcome = import({"iw", "scan.txt", "--robot", "b", "--time", "3.5", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "m: 2 rows, 1 scans, 2 radios of b\n");
  EXPECT_EQ(files_in(folder.path() / "m"),
            (std::vector<std::string>{"mission.yaml", "robots/a/odometry.tum", "robots/b/odometry.tum",
                                      "robots/b/wifi.csv"}));
  EXPECT_EQ(read_file(folder.path() / "m/robots/b/wifi.csv").substr(33, 4), "3.5,");
  const Outcome ran = run({"run", "m", "-o", "out"}, folder.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  expect_refused({"iw", "scan.txt", "-o", "m"}, "has 2 robots; --robot selects");
}

TEST_F(ImportWifi, AddsARobotThatTheMissionDoesNotHave) {
  make_team();
  write_file(folder.path() / "m/mission.yaml",
             "format: radioslam-mission/1\n# by hand\nrobots:\n  a: {}  # first\n  b: {}\n");
  const Outcome outcome = import({"iw", "scan.txt", "--robot", "c", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: robot 'c' is new in this mission\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(read_file(folder.path() / "m/mission.yaml"),
            "format: radioslam-mission/1\n# by hand\nrobots:\n  a: {}  # first\n  b: {}\n  c: {}\n");
  EXPECT_EQ(read_file(folder.path() / "m/robots/c/wifi.csv"), kTable);
  EXPECT_EQ(files_in(folder.path() / "m").size(), 4U);
}

TEST_F(ImportWifi, ReplacesATableOnlyWhenAsked) {
  make_team();
  write_file(folder.path() / "m/robots/a/wifi.csv", "t_s,bssid,frequency_mhz,rssi_dbm\n");
  expect_refused({"iw", "scan.txt", "--robot", "a", "-o", "m"},
                 "robot 'a' has wifi.csv in this mission already");
  expect_refused({"iw", "scan.txt", "-o", "m/robots/a/wifi.csv"}, "is in the mission");
  EXPECT_EQ(import({"iw", "scan.txt", "--robot", "a", "--replace", "-o", "m"}).status, 0);
  EXPECT_EQ(read_file(folder.path() / "m/robots/a/wifi.csv"), kTable);
  EXPECT_EQ(import({"iw", "scan.txt", "-o", "wifi.csv"}).status, 0);
  EXPECT_EQ(import({"iw", "scan.txt", "-o", "wifi.csv"}).status, 0) << "a table alone is replaced";
}

TEST_F(ImportWifi, StartsAMissionThatLacksOdometry) {
  const Outcome outcome = import({"iw", "scan.txt", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(
      outcome.out.starts_with("note: m/robots/scan/odometry.tum is missing, and `radioslam run` needs it: "
                              "`import odometry` takes one"))
      << outcome.out;
  EXPECT_TRUE(outcome.out.ends_with("m: 2 rows, 1 scans, 2 radios of scan\n")) << outcome.out;
  EXPECT_EQ(read_file(folder.path() / "m/robots/scan/wifi.csv"), kTable);
  // Again, into its only robot.
  ASSERT_EQ(import({"iw", "scan.txt", "--time", "1", "--replace", "-o", "m"}).status, 0);
  write_file(folder.path() / "m/robots/scan/odometry.tum", "0 0 0 0 0 0 0 1\n9 2 0 0 0 0 0 1\n");
  const Outcome ran = run({"run", "m", "-o", "out"}, folder.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(ImportWifi, TakesAFolderOfScansTimedByTheirNames) {
  std::filesystem::create_directories(folder.path() / "scans");
  write_file(folder.path() / "scans/scan-1574407125.5.txt", kScan);
  write_file(folder.path() / "scans/scan-1574407123.txt", kScan);
  write_file(folder.path() / "scans/scan-1574407129.txt", "");
  const Outcome outcome = import({"iw", "scans", "--set", "clock_offset_s=-1574407123", "-o", "wifi.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "note: 1 empty files of failed scans were skipped\nwifi.csv: 4 rows, 2 scans, 2 radios\n");
  EXPECT_NE(read_file(folder.path() / "wifi.csv").find("\n2.5,02:00:00:00:01:00,2412,-53.5\n"),
            std::string::npos);
  const Outcome mixed = import({"iw", "scan.txt", "scans", "-o", "out.csv"});
  EXPECT_EQ(mixed.status, 0) << mixed.err;
  EXPECT_NE(mixed.out.find("1 file is left out; the first: scan.txt: has no time"), std::string::npos)
      << mixed.out;
  EXPECT_EQ(import({"iw", "scan.txt", "scans", "--file-times", "-o", "out.csv"}).status, 0);
}

/// Two lists of one log, half a second and more after the machine started at 100 s.
std::string boot_scan(const std::string& address, double heard_s, int age_ms) {
  return "BSS " + address + "(on wlan0)\n\tlast seen: " + std::to_string(heard_s) +
         "s [boottime]\n\tfreq: 2412\n\tsignal: -50.00 dBm\n\tlast seen: " + std::to_string(age_ms) +
         " ms ago\n";
}
const std::string kBootScans = boot_scan("02:00:00:00:01:00", 100.5, 10) +
                               boot_scan("02:00:00:00:02:00", 98.51, 2000) +
                               boot_scan("02:00:00:00:01:00", 104.0, 510);

TEST_F(ImportWifi, AGivenTimeTakesPrecedenceOverTheTimeSinceBoot) {
  write_file(folder.path() / "f.txt", kBootScans);
  write_file(folder.path() / "scan-1574407123.txt", kBootScans);
  const std::string given =
      "t_s,bssid,frequency_mhz,rssi_dbm\n1574407123,02:00:00:00:01:00,2412,-50\n1574407123,02:00:00:00:02:00,"
      "2412,-50\n1574407127,02:00:00:00:01:00,2412,-50\n";
  for (const auto& arguments : {std::vector<std::string>{"iw", "f.txt", "--time", "1574407123"},
                                std::vector<std::string>{"iw", "scan-1574407123.txt"}}) {
    auto call = arguments;
    call.insert(call.end(), {"-o", "wifi.csv"});
    const Outcome outcome = import(call);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_file(folder.path() / "wifi.csv"), given);
    EXPECT_EQ(outcome.out, "wifi.csv: 3 rows, 2 scans, 2 radios\n");
  }
}

TEST_F(ImportWifi, AFilesTimeIsThatOfItsLastScan) {
  write_file(folder.path() / "f.txt", kBootScans);
  using Clock = std::filesystem::file_time_type::clock;
  const auto written = std::chrono::sys_seconds(std::chrono::seconds(1'574'407'127));
  std::filesystem::last_write_time(folder.path() / "f.txt", Clock::from_sys(written));
  ASSERT_EQ(import({"iw", "f.txt", "--file-times", "-o", "wifi.csv"}).status, 0);
  const std::string table = read_file(folder.path() / "wifi.csv");
  EXPECT_NE(table.find("\n1574407123,02:00:00:00:02:00,"), std::string::npos) << table;
  EXPECT_NE(table.find("\n1574407127,02:00:00:00:01:00,"), std::string::npos) << table;
}

TEST_F(ImportWifi, TimesSinceBootAreNotedAndDoNotMixWithOthers) {
  write_file(folder.path() / "f.txt", kBootScans);
  write_file(folder.path() / "scan-1574407123.txt", kBootScans);
  write_file(folder.path() / "lines.txt", "1574407123\n" + kScan);
  const Outcome outcome = import({"iw", "f.txt", "-o", "wifi.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: f.txt: its times are seconds since boot"), std::string::npos)
      << outcome.out;
  EXPECT_NE(read_file(folder.path() / "wifi.csv").find("\n100.51,02:00:00:00:01:00,"), std::string::npos);
  expect_refused({"iw", "f.txt", "scan-1574407123.txt", "-o", "out.csv"}, "f.txt: has only times since");
  expect_refused({"iw", "lines.txt", "f.txt", "-o", "out.csv"}, "f.txt: has only times since");
}

TEST_F(ImportWifi, ReadsTheOtherTools) {
  write_file(
      folder.path() / "iwlist.txt",
      "Cell 01 - Address: 02:00:00:00:01:00\nFrequency:2.412 GHz\nQuality=5/7  Signal level=-53 dBm\n");
  write_file(folder.path() / "nmcli.txt", "02\\:00\\:00\\:00\\:01\\:00:80\n");
  write_file(folder.path() / "log.csv",
             "LocalTime,GPSTime,ESSID,BSSID,Power,Security,Latitude,Longitude,Latitude Error,Longitude "
             "Error,Type\r\n"
             "2019-11-22 07:18:43,1900-01-00 00:00:00,a,02:00:00:00:01:00,-53,,0,0,0,0,AP\r\n");
  EXPECT_EQ(import({"iwlist", "iwlist.txt", "-o", "1.csv"}).status, 0);
  EXPECT_EQ(import({"nmcli", "nmcli.txt", "--fields", "BSSID,SIGNAL", "-o", "2.csv"}).status, 0);
  EXPECT_EQ(import({"airodump", "log.csv", "--set", "utc_offset_h=1", "-o", "3.csv"}).status, 0);
  EXPECT_NE(read_file(folder.path() / "1.csv").find("\n0,02:00:00:00:01:00,2412,-53\n"), std::string::npos);
  EXPECT_NE(read_file(folder.path() / "2.csv").find("\n0,02:00:00:00:01:00,0,-52\n"), std::string::npos);
  EXPECT_NE(read_file(folder.path() / "3.csv").find("\n1574403523,02:00:00:00:01:00,0,-53\n"),
            std::string::npos);
}

TEST_F(ImportWifi, WritesStudiesWithoutOdometry) {
  write_file(folder.path() / "walk.csv",
             "0,num_visible_APs,timestamp,x,y,z,floorID\n-57.0,1,0.0,13.8,1.5,1.4,0\n");
  const Outcome outcome = import({"wifine", "walk.csv", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: the recording has no odometry"), std::string::npos);
  EXPECT_EQ(
      files_in(folder.path() / "m"),
      (std::vector<std::string>{"mission.yaml", "robots/walk/groundtruth.tum", "robots/walk/wifi.csv"}));
  const Outcome similar =
      run({"similarity", "m/robots/walk/wifi.csv", "--measure", "cosine", "-o", "pairs.csv"}, folder.path());
  EXPECT_EQ(similar.status, 0) << similar.err;
}

TEST_F(ImportWifi, RefusesWithTheLine) {
  write_file(folder.path() / "bad.txt", "BSS what(on wlan0)\n");
  write_file(folder.path() / "weak.txt", "BSS 02:00:00:00:01:00(on wlan0)\n\tsignal: 5/100\n");
  write_file(folder.path() / "no.pcap", "this is no capture at all");
  expect_refused({"iw", "bad.txt", "-o", "m"}, "bad.txt:1: 'what' is not a valid address");
  expect_refused({"iw", "weak.txt", "-o", "m"}, "has no signal strengths; 1 readings have no level in dBm");
  expect_refused({"iw", "nowhere.txt", "-o", "m"}, "no such file");
  expect_refused({"iw", "scan.txt", "nowhere.txt", "-o", "m"}, "no such file");
  expect_refused({"pcap", "no.pcap", "-o", "m"}, "no.pcap: at byte 4: unknown file format");
  expect_refused({"airodump", "scan.txt", "-o", "m"}, "scan.txt:1: neither the header");
  expect_refused({"iw", "scan.txt", "--time", "soon", "-o", "m"}, "expected seconds");
  expect_refused({"iw", "scan.txt", "--robot", "a/b", "-o", "m"}, "is not a valid name");
  expect_refused({"iw", "scan.txt", "--fields", "BSSID", "-o", "m"}, "takes no --fields");
  expect_refused({"pcap", "no.pcap", "--time", "1", "-o", "m"}, "takes no --time");
  expect_refused({"wifine", "scan.txt", "scan.txt", "-o", "m"}, "takes one source");
  expect_refused({"iwlst", "scan.txt", "-o", "m"}, "did you mean iwlist");
}

}  // namespace
}  // namespace radioslam::cli
