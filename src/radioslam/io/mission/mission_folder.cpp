#include "radioslam/io/mission/mission_folder.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "radioslam/io/csi/csi_capture.hpp"
#include "radioslam/io/lidar/lidar_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/mission/robot_tables.hpp"
#include "radioslam/io/mission/team_tables.hpp"
#include "radioslam/io/mission/truth_labels.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

fs::path robot_file(const fs::path& folder, const std::string& id, const char* name) {
  return folder / "robots" / id / name;
}

void check_is_mission(const fs::path& folder) {
  if (!fs::exists(folder)) throw InputError(folder.string(), 0, "no such mission folder");
  if (!fs::is_directory(folder)) throw InputError(folder.string(), 0, "is a file, not a mission folder");
  if (!fs::exists(folder / "mission.yaml"))
    throw InputError(folder.string(), 0, "is not a mission: it has no mission.yaml");
}

constexpr const char* kAnchors = "radio/anchors.csv";
constexpr const char* kRanges = "radio/ranges.csv";
constexpr const char* kAoa = "radio/aoa.csv";
constexpr const char* kMatches = "matches.csv";
constexpr const char* kDirectPaths = "radio/direct_paths.csv";
constexpr const char* kMatchLabels = "match_labels.csv";

/// Passes a file's text to `use` if the file exists.
template <class Use>
void with_file(const fs::path& path, Use&& use) {
  if (fs::exists(path)) use(read_text(path));
}

TeamNames names_of(const Mission& mission) {
  TeamNames names;
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    names.robots.emplace(mission.robots[r].id, RobotIndex(r));
  for (std::size_t k = 0; k < mission.anchors.size(); ++k)
    names.anchors.emplace(mission.anchors[k].id, AnchorIndex(k));
  return names;
}

/// Folders of robots that mission.yaml does not list, sorted.
std::set<std::string> unknown_robot_folders(const fs::path& folder, const Mission& mission) {
  const auto known = names_of(mission).robots;
  std::set<std::string> unknown;
  if (!fs::is_directory(folder / "robots")) return unknown;
  for (const auto& entry : fs::directory_iterator(folder / "robots")) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && !name.starts_with('.') && !known.contains(name)) unknown.insert(name);
  }
  return unknown;
}

/// Reads each robot's odometry and lists its scans; it must have one of the two.
void read_motion(const fs::path& folder, const Text& yaml, MissionFile& file) {
  for (std::size_t k = 0; k < file.mission.robots.size(); ++k) {
    Robot& robot = file.mission.robots[k];
    const fs::path path = robot_file(folder, robot.id, "odometry.tum");
    robot.lidar = read_lidar_folder(robot_file(folder, robot.id, "lidar"));
    if (fs::exists(path))
      robot.odometry = read_tum(read_text(path));
    else if (robot.lidar.empty())
      yaml.fail(file.robot_lines[k],
                "robot '" + robot.id + "' has no robots/" + robot.id + "/odometry.tum and no LiDAR scans; " +
                    kOdometrySources,
                InputError::Kind::kTooLittle);
  }
}

Finding respelled(const Robot& robot, const Respelled& spellings) {
  return {"spelling",
          Severity::kWarning,
          robot.id,
          "robots/" + robot.id + "/wifi.csv",
          std::to_string(spellings.count) + " BSSIDs in another spelling than elsewhere, such as '" +
              spellings.example + "' for '" + canonical_bssid(spellings.example) + "'",
          "one spelling of every BSSID",
          "both were read as one address; write it in lower case with colons"};
}

Finding with_control_characters(const Robot& robot, const std::string& note) {
  return {"unreadable",
          Severity::kWarning,
          robot.id,
          "robots/" + robot.id + "/wifi.csv",
          note,
          "text without control characters",
          "columns other than t_s, bssid, frequency_mhz and rssi_dbm are not read; nothing has to be done"};
}

void read_wifi_of(const fs::path& folder, Mission& mission) {
  std::vector<Text> texts;
  std::vector<Robot*> receivers;
  for (Robot& robot : mission.robots) {
    const fs::path path = robot_file(folder, robot.id, "wifi.csv");
    if (!fs::exists(path)) continue;
    texts.push_back(read_tool_output(path));
    receivers.push_back(&robot);
    if (const auto note = control_character_note(texts.back()))
      mission.reading_findings.push_back(with_control_characters(robot, *note));
  }
  WifiRecordings recordings = read_wifi(texts);
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    receivers[k]->wifi = std::move(recordings.receivers[k]);
    if (recordings.respelled[k].count > 0)
      mission.reading_findings.push_back(respelled(*receivers[k], recordings.respelled[k]));
  }
  mission.access_points = std::move(recordings.access_points);
}

void read_robot_tables(const fs::path& folder, Mission& mission) {
  for (Robot& robot : mission.robots) {
    with_file(robot_file(folder, robot.id, "imu.csv"),
              [&](const Text& text) { robot.inertial = read_imu(text); });
    with_file(robot_file(folder, robot.id, "gnss.csv"),
              [&](const Text& text) { robot.fixes = read_fixes(text); });
  }
}

/// Reads the captures of robots whose card is described in mission.yaml; without it, their packets are
/// unknown.
void read_csi_of(const fs::path& folder, Mission& mission) {
  for (Robot& robot : mission.robots) {
    if (!robot.csi) continue;
    robot.csi->captures = read_csi_folder(robot_file(folder, robot.id, "csi"));
    for (const CsiCapture& capture : robot.csi->captures)
      if (robot.csi->carrier_hz == 0) robot.csi->carrier_hz = capture.carrier_hz.value_or(0);
  }
}

void read_team_tables(const fs::path& folder, MissionFile& file) {
  Mission& mission = file.mission;
  with_file(folder / kAnchors, [&](const Text& text) {
    mission.anchors = read_anchors(text, names_of(mission), mission.dimension);
  });
  TeamNames names = names_of(mission);
  names.antennas = file.antennas;
  with_file(folder / kRanges, [&](const Text& text) { mission.ranges = read_ranges(text, names); });
  with_file(folder / kAoa, [&](const Text& text) {
    mission.aoa_measurements = read_aoa(text, names);
    if (auto finding = check_azimuth_unit(text)) mission.reading_findings.push_back(*finding);
  });
  with_file(folder / kMatches, [&](const Text& text) { mission.matches = read_matches(text, names); });
}

/// Data that no estimator reads.
std::vector<std::string> unused_files(const fs::path& folder, const Mission& mission) {
  std::vector<std::string> found;
  for (const Robot& robot : mission.robots)
    if (!robot.csi && fs::is_directory(robot_file(folder, robot.id, "csi")))
      found.push_back("robots/" + robot.id + "/csi");
  std::sort(found.begin(), found.end());
  return found;
}

void write_robot(const fs::path& folder, const Robot& robot, const std::vector<std::string>& access_points) {
  if (!robot.odometry.empty())
    write_file(robot_file(folder, robot.id, "odometry.tum"), format_tum(robot.odometry));
  if (!robot.wifi.empty())
    write_file(robot_file(folder, robot.id, "wifi.csv"), format_wifi(robot.wifi, access_points));
  if (!robot.inertial.empty())
    write_file(robot_file(folder, robot.id, "imu.csv"), format_imu(robot.inertial));
  if (!robot.fixes.empty()) write_file(robot_file(folder, robot.id, "gnss.csv"), format_fixes(robot.fixes));
  write_lidar_folder(robot_file(folder, robot.id, "lidar"), robot.lidar);
  if (robot.csi) write_csi_folder(robot_file(folder, robot.id, "csi"), robot.csi->captures);
}

void write_team_tables(const fs::path& folder, const Mission& mission) {
  if (!mission.anchors.empty()) write_file(folder / kAnchors, format_anchors(mission));
  if (!mission.ranges.empty()) write_file(folder / kRanges, format_ranges(mission));
  if (!mission.aoa_measurements.empty()) write_file(folder / kAoa, format_aoa(mission));
  if (!mission.matches.empty()) write_file(folder / kMatches, format_matches(mission));
}

void write_truth(const fs::path& folder, const Mission& mission, const Truth& truth) {
  for (const RobotTruth& robot : truth.robots)
    if (!robot.poses.empty())
      write_file(robot_file(folder, robot.id, "groundtruth.tum"), format_tum(robot.poses));
  if (!truth.direct_paths.empty())
    write_file(folder / kDirectPaths, format_direct_paths(mission, truth.direct_paths));
  if (!truth.true_matches.empty())
    write_file(folder / kMatchLabels, format_match_labels(mission, truth.true_matches));
}

bool all_unrotated(const Trajectory<SE3>& poses) {
  return std::all_of(poses.begin(), poses.end(),
                     [](const auto& p) { return p.pose.rotation().vec().isZero(0); });
}

}  // namespace

Mission read_mission(const fs::path& folder) {
  check_is_mission(folder);
  const Text yaml = read_text(folder / "mission.yaml");
  const std::string name = fs::weakly_canonical(folder).filename().string();
  MissionFile file = read_mission_yaml(yaml, name);
  for (const std::string& unknown : unknown_robot_folders(folder, file.mission))
    yaml.fail(file.robots_line,
              "unknown robot '" + unknown + "': it has a folder under robots/ but is not listed",
              InputError::Kind::kSpelling);
  read_motion(folder, yaml, file);
  read_wifi_of(folder, file.mission);
  read_robot_tables(folder, file.mission);
  read_csi_of(folder, file.mission);
  read_team_tables(folder, file);
  file.mission.unused_files = unused_files(folder, file.mission);
  return std::move(file.mission);
}

MissionNames read_mission_names(const fs::path& folder) {
  check_is_mission(folder);
  const std::string name = fs::weakly_canonical(folder).filename().string();
  MissionFile file = read_mission_yaml(read_text(folder / "mission.yaml"), name);
  with_file(folder / kAnchors, [&](const Text& text) {
    file.mission.anchors = read_anchors(text, names_of(file.mission), file.mission.dimension);
  });
  return {std::move(file.mission), std::move(file.antennas)};
}

RobotTruth read_robot_truth(const fs::path& file, const std::string& id) {
  RobotTruth truth{id, read_tum(read_text(file))};
  truth.has_orientation = !all_unrotated(truth.poses);
  return truth;
}

Truth read_truth(const fs::path& folder, const Mission& mission) {
  Truth truth;
  for (const Robot& robot : mission.robots) {
    const fs::path path = robot_file(folder, robot.id, "groundtruth.tum");
    truth.robots.push_back(fs::exists(path) ? read_robot_truth(path, robot.id) : RobotTruth{robot.id, {}});
  }
  with_file(folder / kDirectPaths,
            [&](const Text& text) { truth.direct_paths = read_direct_paths(text, mission); });
  with_file(folder / kMatchLabels,
            [&](const Text& text) { truth.true_matches = read_match_labels(text, mission); });
  return truth;
}

void write_mission(const fs::path& folder, const Mission& mission, const Truth& truth) {
  write_file(folder / "mission.yaml", format_mission_yaml(mission));
  for (const Robot& robot : mission.robots) write_robot(folder, robot, mission.access_points);
  write_team_tables(folder, mission);
  write_truth(folder, mission, truth);
}

}  // namespace radioslam
