#include "radioslam/cli/import_lidar.hpp"

#include <filesystem>
#include <iostream>

#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/carmen.hpp"
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

void print_summary(const ImportOptions& options, const ImportedMission& imported) {
  for (const std::string& warning : imported.warnings) std::cout << "note: " << warning << '\n';
  for (const Robot& robot : imported.mission.robots)
    std::cout << options.output << ": " << robot.lidar.size() << " scans, " << robot.odometry.size()
              << " poses of odometry, " << robot.inertial.size() << " inertial readings of " << robot.id << '\n';
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
  print_summary(options, imported);
}

}  // namespace radioslam::cli
