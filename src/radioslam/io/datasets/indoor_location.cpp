#include "radioslam/io/datasets/indoor_location.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLogFolder = "path_data_files";
constexpr const char* kLogExtension = ".txt";

/// RMS error of the compass heading over those walks, some of them near steel structures.
constexpr double kSigmaHeading_rad = 0.25;

bool can_name_a_folder(const std::string& id) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  return !id.empty() && id.front() != '.' && std::all_of(id.begin(), id.end(), is_plain);
}

std::vector<fs::path> find_logs(const fs::path& source) {
  if (!fs::is_directory(source)) return {source};
  std::vector<fs::path> logs = files_in(source, Depth::kBelow, [](const fs::path& file) {
    const fs::path path = fs::absolute(file).lexically_normal();
    return path.extension() == kLogExtension && path.parent_path().filename() == kLogFolder;
  });
  if (logs.empty()) throw InputError(source.string(), 0, "contains no log .../path_data_files/*.txt");
  return logs;
}

void expect_one_floor(const std::vector<fs::path>& logs) {
  for (const fs::path& log : logs)
    if (log.parent_path() != logs.front().parent_path())
      throw InputError(
          log.parent_path().string(), 0,
          "is another floor than " + logs.front().parent_path().string() + "; import one floor at a time");
}

/// All BSSIDs received since their walk began, sorted.
std::vector<std::string> access_points_of(const std::vector<NamedPhoneLog>& walks) {
  std::vector<std::string> bssids;
  for (const auto& walk : walks)
    for (const auto& entry : walk.log.wifi)
      if (walk.log.start <= entry.last_seen) bssids.push_back(entry.bssid);
  std::sort(bssids.begin(), bssids.end());
  bssids.erase(std::unique(bssids.begin(), bssids.end()), bssids.end());
  return bssids;
}

WifiReading reading_of(const ScanEntry& entry, const std::vector<std::string>& access_points) {
  const auto place = std::lower_bound(access_points.begin(), access_points.end(), entry.bssid);
  return {AccessPointIndex(static_cast<std::size_t>(place - access_points.begin())), entry.frequency_mhz,
          entry.rssi_dbm};
}

/// Sorts by access point and keeps the strongest reading of each.
std::vector<WifiReading> tidied(std::vector<WifiReading> readings) {
  std::sort(readings.begin(), readings.end(), [](const WifiReading& a, const WifiReading& b) {
    if (a.access_point != b.access_point) return a.access_point < b.access_point;
    return a.rssi_dbm != b.rssi_dbm ? a.rssi_dbm > b.rssi_dbm : a.frequency_mhz < b.frequency_mhz;
  });
  const auto same = [](const WifiReading& a, const WifiReading& b) {
    return a.access_point == b.access_point;
  };
  readings.erase(std::unique(readings.begin(), readings.end(), same), readings.end());
  return readings;
}

std::vector<WifiScan> scans_of(const PhoneLog& log, const std::vector<std::string>& access_points) {
  std::vector<WifiScan> scans;
  for (const auto& entry : log.wifi) {
    if (entry.last_seen < log.start) continue;
    if (scans.empty() || scans.back().stamp != entry.scan) scans.push_back({entry.scan, {}});
    scans.back().readings.push_back(reading_of(entry, access_points));
  }
  for (auto& scan : scans) scan.readings = tidied(std::move(scan.readings));
  return scans;
}

Robot robot_of(const NamedPhoneLog& walk, const DeadReckoning& reckoned,
               const std::vector<std::string>& access_points) {
  Robot robot;
  robot.id = walk.id;
  set_walk(robot, reckoned);
  robot.wifi = scans_of(walk.log, access_points);
  return robot;
}

std::vector<std::string> warnings_about(const NamedPhoneLog& walk, const DeadReckoning& reckoned) {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& what) { warnings.push_back(walk.id + ": " + what); };
  warnings.insert(warnings.end(), walk.log.warnings.begin(), walk.log.warnings.end());
  if (!walk.log.complete) warn("the log has no end time; the recording may have been cut off");
  if (reckoned.steps.empty()) warn("no steps detected; the robot does not move");
  if (!reckoned.compass) warn("no rotation vector; the heading is relative to the start");
  if (walk.log.wifi.empty()) warn("no WiFi scans");
  return warnings;
}

}  // namespace

void set_walk(Robot& robot, const DeadReckoning& reckoned) {
  robot.odometry = reckoned.odometry;
  robot.odometry_noise = walking_noise();
  robot.heading = reckoned.compass ? Heading::kAbsolute : Heading::kRelative;
  robot.sigma_heading_rad = kSigmaHeading_rad;
}

Trajectory<SE3> waypoints_of(const PhoneLog& log) {
  std::vector<StampedPose<SE3>> poses;
  for (const auto& waypoint : log.waypoints)
    poses.push_back({waypoint.stamp, lift(SE2(waypoint.position_m, 0))});
  return Trajectory<SE3>(std::move(poses));
}

ImportedMission mission_of_walks(const std::vector<NamedPhoneLog>& walks, const std::string& name,
                                 const DeadReckoningParams& params) {
  ImportedMission imported;
  imported.mission.name = name;
  imported.mission.access_points = access_points_of(walks);
  for (const auto& walk : walks) {
    const auto reckoned = dead_reckon(walk.log.motion, walk.log.begin, walk.log.end, params);
    imported.mission.robots.push_back(robot_of(walk, reckoned, imported.mission.access_points));
    imported.truth.robots.push_back({walk.id, waypoints_of(walk.log), false});
    const auto warnings = warnings_about(walk, reckoned);
    imported.warnings.insert(imported.warnings.end(), warnings.begin(), warnings.end());
  }
  return imported;
}

ImportedMission import_indoor_location(const fs::path& source, const DeadReckoningParams& params) {
  const auto paths = find_logs(source);
  expect_one_floor(paths);
  std::vector<NamedPhoneLog> walks;
  SkippedRecords bad;
  for (const fs::path& path : paths)
    bad.attempt([&] {
      const std::string id = path.stem().string();
      if (!can_name_a_folder(id)) throw InputError(path.string(), 0, "its name is not a valid robot name");
      walks.push_back({id, read_phone_log(read_tool_output(path))});
    });
  std::vector<std::string> warnings;
  bad.conclude(source.string(), "walk", walks.size(), warnings);
  const fs::path named_after = fs::absolute(source).lexically_normal();
  const bool is_folder_itself = named_after.filename().empty();  // "folder/"
  ImportedMission imported = mission_of_walks(
      walks, (is_folder_itself ? named_after.parent_path() : named_after).stem().string(), params);
  imported.warnings.insert(imported.warnings.begin(), warnings.begin(), warnings.end());
  return imported;
}

}  // namespace radioslam
