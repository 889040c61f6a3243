#include "radioslam/cli/import/wifi_csv_output.hpp"

#include <algorithm>
#include <filesystem>

#include "radioslam/cli/import/import_options.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/csv_files.hpp"
#include "radioslam/io/text/valid_id.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> robots_in_mission(const fs::path& mission) {
  std::vector<std::string> ids;
  for (const Robot& robot : read_mission_yaml(read_text(mission / kMissionFolder), "").mission.robots)
    ids.push_back(robot.id);
  return ids;
}

}  // namespace

WifiCsvOutput::WifiCsvOutput(const std::string& output, const std::string& robot, const std::string& source)
    : output_(output), robot_(robot) {
  if (!robot.empty()) check_import_id("--robot " + robot, robot);
  if (output.ends_with(".csv")) {
    file_.emplace(table_ = output);
  } else if (fs::exists(fs::path(output) / kMissionFolder)) {
    find_robot_of_mission();
    file_.emplace(table_ = file_of_robot("wifi.csv"));
  } else {
    if (robot_.empty()) name_robot_after(source);
    folder_.emplace(output, kMissionFolder);
  }
}

std::string WifiCsvOutput::replaced() const { return file_ ? table_ : output_; }

void WifiCsvOutput::find_robot_of_mission() {
  const auto ids = robots_in_mission(output_);
  if (robot_.empty() && ids.size() == 1) robot_ = ids.front();
  if (robot_.empty())
    throw InputError(output_, 0,
                     "this mission has " + std::to_string(ids.size()) +
                         " robots; --robot selects the one that recorded this");
  if (std::find(ids.begin(), ids.end(), robot_) == ids.end())
    throw InputError("--robot " + robot_, 0,
                     "the mission " + output_ + " has no such robot" + did_you_mean(robot_, ids));
}

void WifiCsvOutput::name_robot_after(const std::string& source) {
  robot_ = name_of_source(source);
  if (!is_valid_id(robot_))
    throw InputError(source, 0, "its name is not a valid robot name; --robot sets another one");
}

std::string WifiCsvOutput::file_of_robot(const char* name) const {
  return (fs::path(output_) / "robots" / robot_ / name).string();
}

void WifiCsvOutput::commit(const std::vector<WifiRow>& rows) {
  const std::string table = format_wifi_rows(rows);
  if (file_) return file_->commit(table);
  Mission mission;
  mission.name = name_of_source(output_);
  mission.robots.emplace_back().id = robot_;
  write_mission(folder_->path(), mission);
  write_file(folder_->path() / "robots" / robot_ / "wifi.csv", table);
  folder_->commit();
}

std::string WifiCsvOutput::missing() const {
  if (robot_.empty() || output_.ends_with(".csv")) return {};
  const std::string odometry = file_of_robot("odometry.tum");
  return fs::exists(odometry) ? "" : odometry + " is missing; `radioslam run` needs it";
}

}  // namespace radioslam::cli
