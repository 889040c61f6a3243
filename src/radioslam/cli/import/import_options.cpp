#include "radioslam/cli/import/import_options.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// Adds an option that may be repeated, each time with one value.
void add_repeated_option(CLI::App& command, const char* name, std::vector<std::string>& values,
                         const char* type, const char* what) {
  command.add_option(name, values, what)->type_name(type)->expected(1)->take_all();
}

void add_time_options(CLI::App& command, ImportOptions& options) {
  command
      .add_option("--time", options.time,
                  "Time of the first scan in a file without times (default: the time in the file's name, or "
                  "else iw's seconds since boot, or else 0)")
      ->type_name("SECONDS");
  command.add_flag("--file-times", options.file_times,
                   "Take a file's last modification as the time of its last scan, if it has no times");
}

void add_topic_options(CLI::App& command, ImportOptions& options) {
  add_repeated_option(command, "--odometry", options.odometry, "TOPIC",
                      "Topic of Odometry or poses, or /tf:FRAME.CHILD, or none (default: the only Odometry)");
  add_repeated_option(command, "--scans", options.scans, "TOPIC",
                      "Topic of PointCloud2 or LaserScan, or none (default: the only one)");
  add_repeated_option(command, "--imu", options.imu, "TOPIC",
                      "Topic of Imu, or none (default: the only one)");
  add_repeated_option(command, "--gnss", options.gnss, "TOPIC",
                      "Topic of NavSatFix, or none (default: the only one)");
  add_repeated_option(command, "--wifi", options.wifi, "TOPIC",
                      "Topic of WiFi readings, or none (default: the only one)");
  add_repeated_option(command, "--truth", options.truth, "TOPIC",
                      "Topic of the true poses, as for --odometry (default: none)");
  add_repeated_option(command, "--ranges", options.ranges, "TOPIC=ID,ID",
                      "Topic of Range and the two robots or anchors that it is between (default: those named "
                      "in the topic or its frame)");
  command.add_flag("--list", options.list,
                   "Only list the topics with their types and numbers of messages; needs no -o");
}

void refuse_unless(bool is_fine, const ImportOptions& options, const char* option) {
  if (!is_fine) throw InputError("import " + options.kind, 0, std::string("takes no ") + option);
}

}  // namespace

void add_common_options(CLI::App& command, ImportOptions& options) {
  command.add_option("SOURCE", options.sources, "File or folder to import; some kinds take several")
      ->required();
  command
      .add_option("-o,--output", options.output,
                  "Mission or table to write (required); a mission that is there gets another robot, or "
                  "what its robot of this name lacks")
      ->type_name("PATH");
  command.add_flag("--replace", options.replace,
                   "Replace what the mission has of the recordings that this import brings");
  add_threads_option(command);
}

void add_import_option(CLI::App& command, ImportOptions& options, ImportOption option) {
  switch (option) {
    case ImportOption::kRobot:
      return add_repeated_option(command, "--robot", options.robots, "ID",
                                 "Name of the robot that made the recording");
    case ImportOption::kRobots:
      return add_repeated_option(
          command, "--robot", options.robots, "ID",
          "Name of a source's robot, once per source (default: a, b, ...; of several ROS "
          "recordings, their names)");
    case ImportOption::kName:
      return add_repeated_option(command, "--name", options.names, "RADIO=ID",
                                 "Robot or anchor that has a radio: its BSSID, or its name in ROS topics and "
                                 "frames (default: the radio itself)");
    case ImportOption::kFields:
      command.add_option("--fields", options.fields, "The fields given to nmcli's -f")->type_name("NAME,...");
      return;
    case ImportOption::kTime:
      return add_time_options(command, options);
    case ImportOption::kPoses:
      return add_repeated_option(command, "--poses", options.poses, "FILE",
                                 "True poses, twelve numbers per line, once per source (default: the poses "
                                 "file next to the scans)");
    case ImportOption::kTopics:
      return add_topic_options(command, options);
    case ImportOption::kParameters:
      return add_parameter_options(command, options.parameters);
  }
}

void add_all_import_options(CLI::App& command, ImportOptions& options) {
  add_common_options(command, options);
  const std::size_t common = command.get_options().size();
  for (const ImportOption option :
       {ImportOption::kRobots, ImportOption::kName, ImportOption::kFields, ImportOption::kTime,
        ImportOption::kPoses, ImportOption::kTopics, ImportOption::kParameters})
    add_import_option(command, options, option);
  const std::vector<CLI::Option*> all = command.get_options();
  for (std::size_t k = common; k < all.size(); ++k) all[k]->group("");  // hidden
}

void refuse_other_options(const ImportOptions& options, const std::vector<ImportOption>& taken) {
  const auto takes = [&](ImportOption option) {
    return std::find(taken.begin(), taken.end(), option) != taken.end();
  };
  refuse_unless(options.robots.empty() || takes(ImportOption::kRobot) || takes(ImportOption::kRobots),
                options, "--robot");
  refuse_unless(options.robots.size() <= 1 || takes(ImportOption::kRobots), options, "second --robot");
  refuse_unless(options.names.empty() || takes(ImportOption::kName), options, "--name");
  refuse_unless(options.fields.empty() || takes(ImportOption::kFields), options, "--fields");
  refuse_unless(options.poses.empty() || takes(ImportOption::kPoses), options, "--poses");
  const bool has_topics = options.list || !options.odometry.empty() || !options.scans.empty() ||
                          !options.imu.empty() || !options.gnss.empty() || !options.truth.empty() ||
                          !options.wifi.empty() || !options.ranges.empty();
  refuse_unless(!has_topics || takes(ImportOption::kTopics), options, "ROS topics");
  refuse_unless(options.time.empty() || takes(ImportOption::kTime), options, "--time");
  const bool has_settings = !options.parameters.set.empty() || !options.parameters.config_path.empty();
  refuse_unless(!has_settings || takes(ImportOption::kParameters), options, "parameters");
  refuse_unless(!options.file_times || takes(ImportOption::kTime), options, "--file-times");
}

ImportedRobot robot_of_import(const ImportOptions& options) {
  if (!options.robot.empty()) check_import_id("--robot " + options.robot, options.robot);
  ImportedRobot robot{options.robot};
  const fs::path yaml = fs::path(options.output) / kMissionFolder;
  if (!fs::exists(yaml)) {
    if (robot.id.empty()) robot.id = name_of_source(options.sources.front());
    if (!is_valid_id(robot.id))
      throw InputError(options.sources.front(), 0,
                       "its name is not a valid robot name; --robot sets another one");
    return robot;
  }
  const std::vector<Robot> robots = read_mission_yaml(read_text(yaml), "").mission.robots;
  if (robot.id.empty() && robots.size() == 1) robot.id = robots.front().id;
  if (robot.id.empty())
    throw InputError(options.output, 0,
                     "this mission has " + std::to_string(robots.size()) +
                         " robots; --robot selects the one that recorded this");
  robot.is_added =
      std::none_of(robots.begin(), robots.end(), [&](const Robot& other) { return other.id == robot.id; });
  return robot;
}

std::vector<std::string> notes_on(const ImportOptions& options, const ImportedRobot& robot) {
  const fs::path folder = fs::path(options.output) / "robots" / robot.id;
  std::vector<std::string> notes;
  if (robot.is_added) notes.push_back("robot '" + robot.id + "' is new in this mission");
  if (!fs::exists(folder / "odometry.tum") && !fs::is_directory(folder / "lidar"))
    notes.push_back((folder / "odometry.tum").string() + " is missing, and `radioslam run` needs it: " +
                    kOdometrySources + "; `radioslam similarity` compares the scans without it");
  return notes;
}

void refuse_table_of_mission(const ImportOptions& options) {
  constexpr int kDepth = 3;  // robots/ID/wifi.csv
  if (options.replace || !fs::exists(options.output)) return;
  fs::path folder = fs::absolute(options.output).lexically_normal().parent_path();
  for (int depth = 0; depth < kDepth; ++depth, folder = folder.parent_path())
    if (fs::exists(folder / kMissionFolder))
      throw InputError(options.output, 0,
                       "is in the mission " + folder.string() + " already; --replace replaces it",
                       InputError::Kind::kDuplicate);
}

void check_import_id(const std::string& option, const std::string& id) {
  if (!is_valid_id(id))
    throw InputError(option, 0, "'" + id + "' is not a valid name of a robot or an anchor");
}

std::vector<std::string> robot_letters(std::size_t count) {
  constexpr std::size_t kLetters = 26;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < count && count <= kLetters; ++k)
    names.emplace_back(1, static_cast<char>('a' + k));
  return names;
}

std::vector<std::string> robots_of_import(const ImportOptions& options, std::size_t sources,
                                          std::vector<std::string> otherwise) {
  std::vector<std::string> robots = options.robots.empty() ? std::move(otherwise) : options.robots;
  if (robots.size() != sources)
    throw InputError(
        "import " + options.kind, 0,
        std::to_string(sources) + " sources but " + std::to_string(robots.size()) + " --robot are given");
  for (const std::string& robot : robots) check_import_id("--robot " + robot, robot);
  const std::set<std::string> different(robots.begin(), robots.end());
  if (different.size() != robots.size()) throw InputError("--robot", 0, "two robots have the same name");
  return robots;
}

std::string value_for(const std::vector<std::string>& values, const char* option, std::size_t k,
                      std::size_t sources) {
  if (values.size() <= 1) return values.empty() ? std::string{} : values.front();
  if (values.size() != sources)
    throw InputError(
        option, 0,
        "is given " + std::to_string(values.size()) + " times for " + std::to_string(sources) + " sources");
  return values[k];
}

}  // namespace radioslam::cli
