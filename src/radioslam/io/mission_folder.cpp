#include "radioslam/io/mission_folder.hpp"

#include <algorithm>
#include <set>

#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/mission_yaml.hpp"
#include "radioslam/io/team_tables.hpp"
#include "radioslam/io/tum.hpp"
#include "radioslam/io/wifi_csv.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

fs::path robot_file(const fs::path& folder, const std::string& id, const char* name) {
  return folder / "robots" / id / name;
}

void check_is_mission(const fs::path& folder) {
  if (!fs::exists(folder)) throw InputError(folder.string(), 0, "no such mission folder");
  if (!fs::is_directory(folder)) throw InputError(folder.string(), 0, "is a file, a mission is a folder");
  if (!fs::exists(folder / "mission.yaml"))
    throw InputError(folder.string(), 0, "is not a mission: it has no mission.yaml");
}

std::set<std::string, std::less<>> robot_ids(const Mission& mission) {
  std::set<std::string, std::less<>> ids;
  for (const Robot& robot : mission.robots) ids.insert(robot.id);
  return ids;
}

/// Folders of robots that mission.yaml does not list, sorted.
std::set<std::string> unknown_robot_folders(const fs::path& folder, const Mission& mission) {
  const auto known = robot_ids(mission);
  std::set<std::string> unknown;
  if (!fs::is_directory(folder / "robots")) return unknown;
  for (const auto& entry : fs::directory_iterator(folder / "robots")) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && !name.starts_with('.') && !known.contains(name)) unknown.insert(name);
  }
  return unknown;
}

void read_odometry(const fs::path& folder, const Text& yaml, MissionFile& file) {
  for (std::size_t k = 0; k < file.mission.robots.size(); ++k) {
    Robot& robot = file.mission.robots[k];
    const fs::path path = robot_file(folder, robot.id, "odometry.tum");
    if (!fs::exists(path))
      yaml.fail(file.robot_lines[k], "robot '" + robot.id + "' has no robots/" + robot.id + "/odometry.tum");
    robot.odometry = read_tum(read_text(path));
  }
}

void read_wifi_of(const fs::path& folder, Mission& mission) {
  std::vector<Text> texts;
  std::vector<Robot*> receivers;
  for (Robot& robot : mission.robots) {
    const fs::path path = robot_file(folder, robot.id, "wifi.csv");
    if (!fs::exists(path)) continue;
    texts.push_back(read_text(path));
    receivers.push_back(&robot);
  }
  WifiRecordings recordings = read_wifi(texts);
  for (std::size_t k = 0; k < receivers.size(); ++k) receivers[k]->wifi = std::move(recordings.receivers[k]);
  mission.access_points = std::move(recordings.access_points);
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
              "unknown robot '" + unknown + "': it has a folder under robots/ and is not listed");
  read_odometry(folder, yaml, file);
  read_wifi_of(folder, file.mission);
  file.mission.unused_files = check_team_tables(folder, {robot_ids(file.mission)});
  return std::move(file.mission);
}

Truth read_truth(const fs::path& folder, const Mission& mission) {
  Truth truth;
  for (const Robot& robot : mission.robots) {
    RobotTruth& entry = truth.robots.emplace_back();
    entry.id = robot.id;
    const fs::path path = robot_file(folder, robot.id, "groundtruth.tum");
    if (!fs::exists(path)) continue;
    entry.poses = read_tum(read_text(path));
    entry.has_orientation = !all_unrotated(entry.poses);
  }
  return truth;
}

void write_mission(const fs::path& folder, const Mission& mission, const Truth& truth) {
  write_file(folder / "mission.yaml", format_mission_yaml(mission));
  for (const Robot& robot : mission.robots) {
    write_file(robot_file(folder, robot.id, "odometry.tum"), format_tum(robot.odometry));
    if (!robot.wifi.empty())
      write_file(robot_file(folder, robot.id, "wifi.csv"), format_wifi(robot.wifi, mission.access_points));
  }
  for (const RobotTruth& robot : truth.robots)
    if (!robot.poses.empty())
      write_file(robot_file(folder, robot.id, "groundtruth.tum"), format_tum(robot.poses));
}

}  // namespace radioslam
