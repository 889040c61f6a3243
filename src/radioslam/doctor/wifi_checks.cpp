#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/fingerprint_clock.hpp"
#include "radioslam/doctor/moving_access_points.hpp"
#include "radioslam/doctor/sensor_checks.hpp"
#include "radioslam/doctor/team_links.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

class RobotWifi {
 public:
  RobotWifi(const Mission& mission, const Robot& robot, std::vector<Finding>& findings)
      : mission_(mission), robot_(robot), findings_(findings), track_(robot.odometry) {}

  void run() {
    if (robot_.wifi.empty()) return;
    if (check_amount() || check_units()) return;
    check_repeats();
    if (track_.path_m() < 10) return;
    check_access_points(mission_, robot_, track_, findings_);
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

  /// Scans equal to the one before, although the robot moved: results that the system kept.
  void check_repeats() {
    std::size_t compared = 0, repeated = 0;
    for (std::size_t k = 1; k < robot_.wifi.size(); ++k) {
      const auto &before = robot_.wifi[k - 1].readings, &now = robot_.wifi[k].readings;
      if (now.size() < 4) continue;
      ++compared;
      repeated +=
          std::equal(before.begin(), before.end(), now.begin(), now.end(), [](const auto& x, const auto& y) {
            return x.access_point == y.access_point && x.rssi_dbm == y.rssi_dbm;
          });
    }
    if (compared < 10 || static_cast<double>(repeated) < 0.2 * static_cast<double>(compared)) return;
    add("stale", Severity::kWarning,
        std::to_string(repeated) + " of " + std::to_string(compared) + " scans repeat the scan before",
        "new readings in every scan", "remove repeated scans: they are older than their times say");
  }

  const Mission& mission_;
  const Robot& robot_;
  std::vector<Finding>& findings_;
  Track track_;
};

/// One address in two spellings, such as aa:bb and aa-bb.
void check_spellings(const Mission& mission, std::vector<Finding>& findings) {
  std::map<std::string, std::string> spelled;
  for (const std::string& address : mission.access_points) {
    std::string digits;
    for (const char c : address)
      if (std::isalnum(static_cast<unsigned char>(c))) digits += c;
    const auto [entry, is_new] = spelled.try_emplace(digits, address);
    if (is_new) continue;
    findings.push_back({"spelling", Severity::kWarning, "", "",
                        "'" + entry->second + "' and '" + address + "' are one address",
                        "one spelling of every BSSID", "write it with colons everywhere"});
    return;
  }
}

/// Robots whose scans are the same row for row.
void check_same_scans(const Mission& mission, std::vector<Finding>& findings) {
  const auto same = [](const WifiScan& x, const WifiScan& y) {
    return std::equal(x.readings.begin(), x.readings.end(), y.readings.begin(), y.readings.end(),
                      [](const auto& a, const auto& b) {
                        return a.access_point == b.access_point && a.rssi_dbm == b.rssi_dbm;
                      });
  };
  for (std::size_t b = 1; b < mission.robots.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const auto &x = mission.robots[a].wifi, &y = mission.robots[b].wifi;
      if (x.size() < 5 || x.size() != y.size() || !std::equal(x.begin(), x.end(), y.begin(), same)) continue;
      findings.push_back(
          {"duplicate", Severity::kError, mission.robots[b].id, robot_file(mission.robots[b].id, "wifi.csv"),
           "the same scans as those of robot '" + mission.robots[a].id + "'", "a recording of its own",
           "remove one of the two, or replace it by the right recording"});
      break;
    }
}

}  // namespace

std::vector<Finding> check_wifi(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots) RobotWifi(mission, robot, findings).run();
  check_spellings(mission, findings);
  check_same_scans(mission, findings);
  return findings;
}

}  // namespace radioslam
