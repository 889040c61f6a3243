// Two robots' `iw` logs and odometry files become a team by commands alone, as the README describes.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/import_fixture.hpp"

namespace radioslam::cli {
namespace {

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, separator);) fields.push_back(field);
  return fields;
}

/// A wifi.csv as the log of `date +%s.%N; iw dev wlan0 scan` in a loop.
std::string iw_log(const std::string& table) {
  std::string log, last;
  const auto lines = split(table, '\n');
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto row = split(lines[k], ',');
    if (row[0] != last) log += (last = row[0]) + "\n";
    log += "BSS " + row[1] + "(on wlan0)\n\tfreq: " + row[2] + "\n\tsignal: " + row[3] +
           " dBm\n\tlast seen: 20 ms ago\n\tSSID: " + std::string(k == 1 ? "caf\x07" : "office") + "\n";
  }
  return log;
}

/// Planar odometry as another program logs it, in a frame of its own.
std::string odometry_log(const std::string& tum) {
  std::string log = "time;x;y;yaw_deg\n";
  for (const std::string& line : split(tum, '\n')) {
    const auto row = split(line, ' ');
    const double yaw_rad = 2 * std::atan2(std::stod(row[6]), std::stod(row[7]));
    log += row[0] + ';' + std::to_string(7 - std::stod(row[2])) + ';' +
           std::to_string(std::stod(row[1]) - 3) + ';' + std::to_string(yaw_rad * 57.29577951308232 + 90) +
           '\n';
  }
  return log;
}

TEST_F(ImportFixture, TwoScanLogsAndTwoOdometryFilesBecomeATeam) {
  ASSERT_EQ(run({"simulate", "carpark", "-o", "drive", "--seed", "3", "--set", "path_length_m=200", "--set",
                 "known_start=false", "--set", "floor_x_m=40", "--set", "floor_y_m=30", "--set", "phones=2"},
                folder.path())
                .status,
            0);
  for (const std::string robot : {"a", "b"}) {
    const auto recorded = folder.path() / "drive/robots" / robot;
    write_file(folder.path() / (robot + ".log"), iw_log(read_file(recorded / "wifi.csv")));
    const std::string tum = read_file(recorded / "odometry.tum");
    write_file(folder.path() / (robot + ".odom"), robot == "a" ? tum : odometry_log(tum));
    const Outcome scans = import({"iw", robot + ".log", "--robot", robot, "-o", "mission"});
    ASSERT_EQ(scans.status, 0) << scans.err;
    EXPECT_NE(scans.out.find("has control characters"), std::string::npos) << scans.out;
    const Outcome odometry = import({"odometry", robot + ".odom", "--robot", robot, "-o", "mission"});
    ASSERT_EQ(odometry.status, 0) << odometry.err;
  }
  const Outcome ran = run({"run", "mission", "-o", "out"}, folder.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "out/summary.json"));
  EXPECT_EQ(summary["team_frame"]["components"].dump(), R"([["a","b"]])");
  const Outcome evaluated = run({"evaluate", "out", "--json", "--truth", "a=drive/robots/a/groundtruth.tum",
                                 "b=drive/robots/b/groundtruth.tum"},
                                folder.path());
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  EXPECT_LT(nlohmann::json::parse(evaluated.out)["ate_rmse_m"].get<double>(), 1);
}

TEST_F(ImportFixture, OdometryOfAnotherProgramBeginsAtItsStart) {
  write_file(folder.path() / "odom.csv", "t_s,x,y,yaw\n5,2,3,1.5707963267948966\n6,2,4,1.5707963267948966\n");
  const Outcome outcome = import({"odometry", "odom.csv", "--robot", "a", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("m: 2 poses, 1 m of odometry of a"), std::string::npos) << outcome.out;
  const auto rows = split(read_file(folder.path() / "m/robots/a/odometry.tum"), '\n');
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(std::stod(split(rows[1], ' ')[1]), 1, 1e-9) << "ahead";
  EXPECT_NEAR(std::stod(split(rows[1], ' ')[6]), 0, 1e-9) << "not turned";
  expect_refused({"odometry", "odom.csv", "--robot", "a", "-o", "m"}, "robot 'a' has odometry.tum");
  write_file(folder.path() / "plan.csv", "t_s,x,y\n5,2,3\n");
  expect_refused({"odometry", "plan.csv", "--robot", "b", "-o", "m"}, "no columns of a time, x, y, and yaw");
}

TEST_F(ImportFixture, APhonesScansBecomeThoseOfARobot) {
  write_file(folder.path() / "wigle.csv",
             "WigleWifi-1.4,appRelease=2.53\nMAC,SSID,AuthMode,FirstSeen,Channel,RSSI,CurrentLatitude,"
             "CurrentLongitude,AltitudeMeters,AccuracyMeters,Type\n"
             "02:aa:00:00:01:00,na\x01me,[],2019-11-22 07:18:43,6,-53,1,2,3,4,WIFI\n");
  const Outcome outcome = import({"android", "wigle.csv", "--robot", "a", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("wigle.csv:3: has control characters"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("m: 1 rows, 1 scans, 1 radios of a\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(read_file(folder.path() / "m/robots/a/wifi.csv"),
            "t_s,bssid,frequency_mhz,rssi_dbm\n1574407123,02:aa:00:00:01:00,2437,-53\n");
  expect_refused({"android", "wigle.csv", "--robot", "a", "-o", "m"}, "robot 'a' has wifi.csv");
  write_file(folder.path() / "other.csv", "a,b\n1,2\n");
  expect_refused({"android", "other.csv", "--robot", "b", "-o", "m"}, "is neither a table of WiFi scans");
}

}  // namespace
}  // namespace radioslam::cli
