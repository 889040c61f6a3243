#include <algorithm>
#include <string>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/team_links.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

/// The same access points with the same strengths.
bool same_readings(const WifiScan& a, const WifiScan& b) {
  return std::equal(a.readings.begin(), a.readings.end(), b.readings.begin(), b.readings.end(),
                    [](const WifiReading& x, const WifiReading& y) {
                      return x.access_point == y.access_point && x.rssi_dbm == y.rssi_dbm;
                    });
}

class RobotWifi {
 public:
  RobotWifi(const Mission& mission, const Robot& robot, std::vector<Finding>& findings)
      : mission_(mission), robot_(robot), findings_(findings), track_(robot) {}

  void run() {
    if (robot_.wifi.empty()) return;
    if (check_amount() || check_units()) return;
    if (track_.path_m() < 10) return;
    check_access_points(mission_, robot_, track_, findings_);
    check_stale_scans(robot_, track_, findings_);
    check_fingerprint_clock(robot_, track_, findings_);
  }

 private:
  void add(const char* kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back({kind, severity, robot_.id, robot_file(robot_.id, "wifi.csv"), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  bool check_amount() {
    if (robot_.wifi.size() >= 3) return false;
    add("too-little", Severity::kWarning, std::to_string(robot_.wifi.size()) + " scans",
        "a scan every few seconds", "the robot cannot be placed by fingerprints");
    return true;
  }

  bool check_units() {
    std::vector<double> rssi, frequency;
    for (const WifiScan& scan : robot_.wifi)
      for (const WifiReading& reading : scan.readings) {
        rssi.push_back(static_cast<double>(reading.rssi_dbm));
        if (reading.frequency_mhz > 0) frequency.push_back(static_cast<double>(reading.frequency_mhz));
      }
    if (rssi.empty()) return false;
    const double strength = median(rssi);
    if (strength > -15 || strength < -115) {
      add("unit", Severity::kError, "the median of rssi_dbm is " + number(strength), "-30 to -100 dBm",
          strength > 15 ? "restore the minus sign, or convert percent" : "convert to dBm");
      return true;
    }
    if (frequency.empty()) return false;
    const double typical = median(frequency);
    if (typical < 600 || typical > 100000)
      add("unit", Severity::kWarning, "the median of frequency_mhz is " + number(typical), "2400 to 7200 MHz",
          typical < 10    ? "convert GHz to MHz"
          : typical < 600 ? "convert channels to MHz"
                          : "convert kHz or Hz to MHz");
    return false;
  }

  const Mission& mission_;
  const Robot& robot_;
  std::vector<Finding>& findings_;
  Track track_;
};

/// Whether the scans of two robots are the same row for row.
bool same_scans(const Robot& a, const Robot& b) {
  return a.wifi.size() >= 5 &&
         std::equal(a.wifi.begin(), a.wifi.end(), b.wifi.begin(), b.wifi.end(), same_readings);
}

}  // namespace

std::vector<Finding> check_wifi(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots) RobotWifi(mission, robot, findings).run();
  add_duplicates(
      mission, same_scans, [](const std::string& id) { return robot_file(id, "wifi.csv"); },
      {"duplicate", Severity::kError, "", "", "the same scans as those of", "a recording of its own",
       "remove one of the two, or replace it by the right recording"},
      findings);
  return findings;
}

}  // namespace radioslam
