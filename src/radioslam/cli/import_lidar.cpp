#include "radioslam/cli/import_lidar.hpp"

#include <filesystem>
#include <iostream>

#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/carmen.hpp"
#include "radioslam/io/kitti_sequence.hpp"
#include "radioslam/io/mission_folder.hpp"
#include "radioslam/io/packed_text.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// The robot that --robot names, or a.
std::string robot_named(const ImportOptions& options) {
  if (options.robot.empty()) return "a";
  check_import_id("--robot " + options.robot, options.robot);
  return options.robot;
}

/// "intel" of logs/intel.clf.bz2 and of logs/intel/.
std::string name_of(const std::string& source) {
  fs::path path = fs::absolute(source).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  const std::string name = path.filename().string();
  return fs::is_directory(path) ? name : name.substr(0, name.find('.', 1));
}

void print_notes(const ImportedMission& imported) {
  for (const std::string& warning : imported.warnings) std::cout << "note: " << warning << '\n';
}

}  // namespace

void import_carmen_log(const ImportOptions& options) {
  const auto params = params_of<CarmenParams>(options);
  const std::string robot = robot_named(options);
  OutputFolder output(options.output, kMissionFolder);
  ImportedMission imported = read_carmen(read_packed_text(only_source(options)), robot, params);
  imported.mission.name = name_of(only_source(options));
  write_mission(output.path(), imported.mission, imported.truth);
  output.commit();
  print_notes(imported);
  std::cout << options.output << ": " << imported.mission.robots[0].lidar.size() << " scans and odometry of "
            << robot << '\n';
}

void import_kitti_drive(const ImportOptions& options) {
  const std::string robot = robot_named(options);
  OutputFolder output(options.output, kMissionFolder);
  KittiDrive drive = read_kitti_drive(only_source(options), robot, options.poses);
  drive.imported.mission.name = name_of(only_source(options));
  write_mission(output.path(), drive.imported.mission, drive.imported.truth);
  copy_kitti_scans(drive.scans, output.path() / "robots" / robot / "lidar");
  output.commit();
  print_notes(drive.imported);
  std::cout << options.output << ": " << drive.scans.size() << " scans of " << robot << ", "
            << (drive.imported.truth.robots.empty() ? "no truth" : "and the truth") << '\n';
}

}  // namespace radioslam::cli
