#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>

#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/import/import_commands.hpp"
#include "radioslam/cli/import/ros_sources.hpp"
#include "radioslam/cli/import/wifi_summary.hpp"
#include "radioslam/io/lidar/carmen.hpp"
#include "radioslam/io/lidar/kitti_sequence.hpp"
#include "radioslam/io/lidar/lidar_folder.hpp"
#include "radioslam/io/ros/ros_import.hpp"
#include "radioslam/io/ros/ros_ranges.hpp"
#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// A name for a source: "intel" for logs/intel.clf.bz2 and for logs/intel/.
std::string name_of(const std::string& source) {
  fs::path path = fs::absolute(source).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  const std::string name = path.filename().string();
  return fs::is_directory(path) ? name : name.substr(0, name.find('.', 1));
}

/// The output folder, after checking that it would replace no input.
const std::string& folder_apart(const ImportOptions& options) {
  refuse_replacing_inputs(options.output, options.sources);
  refuse_replacing_inputs(options.output, options.poses);
  return options.output;
}

/// Collects a mission robot by robot and writes its folder.
class TeamOutput {
 public:
  /// Refuses robots that the mission has.
  TeamOutput(const ImportOptions& options, const std::vector<std::string>& robots)
      : options_(options), output_(folder_apart(options), existing_of(options)) {
    for (const std::string& robot : robots) output_.expect_free(robot, !options.robots.empty());
    team_.mission.dimension = 2;
    team_.mission.name = name_of(options.sources.size() == 1 ? options.sources.front() : options.output);
  }

  fs::path folder_of(const std::string& robot) const { return output_.folder_of(robot); }
  fs::path scans_of(const std::string& robot) const { return folder_of(robot) / "lidar"; }

  /// `what` is a one-line summary of the robot's data.
  void add(ImportedMission one, const std::string& what) {
    team_.mission.dimension = std::max(team_.mission.dimension, one.mission.dimension);
    std::move(one.mission.robots.begin(), one.mission.robots.end(), std::back_inserter(team_.mission.robots));
    std::move(one.truth.robots.begin(), one.truth.robots.end(), std::back_inserter(team_.truth.robots));
    for (const std::string& warning : one.warnings) lines_.push_back("note: " + warning);
    lines_.push_back(options_.output + ": " + what);
  }

  void note(const std::string& text) { lines_.push_back("note: " + text); }

  /// Adds ranges between the robots added before and anchors without positions.
  void add_ranges(const std::vector<RosRange>& ranges) {
    for (const RosRange& range : ranges)
      team_.mission.ranges.push_back(
          {range.stamp, end_of(range.i), end_of(range.j), range.range_m, range.sigma_m});
    std::stable_sort(team_.mission.ranges.begin(), team_.mission.ranges.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  }

  void commit() {
    output_.commit(team_.mission, team_.truth);
    for (const std::string& note : output_.notes()) std::cout << "note: " << note << '\n';
    for (const std::string& line : lines_) std::cout << line << '\n';
  }

 private:
  LinkEnd end_of(const std::string& id) {
    const auto& robots = team_.mission.robots;
    auto& anchors = team_.mission.anchors;
    const auto robot = std::find_if(robots.begin(), robots.end(), [&](const auto& r) { return r.id == id; });
    LinkEnd end;
    if (robot != robots.end()) {
      end.robot = RobotIndex(static_cast<std::size_t>(robot - robots.begin()));
      return end;
    }
    const auto anchor =
        std::find_if(anchors.begin(), anchors.end(), [&](const auto& a) { return a.id == id; });
    end.anchor = AnchorIndex(static_cast<std::size_t>(anchor - anchors.begin()));
    if (anchor == anchors.end()) anchors.push_back({id, std::nullopt, 0});
    return end;
  }

  const ImportOptions& options_;
  MissionOutput output_;
  ImportedMission team_;
  std::vector<std::string> lines_;
};

void list_topics(const ImportOptions& options) {
  std::vector<fs::path> recordings;
  for (const std::string& source : options.sources)
    for (const fs::path& recording : recordings_in(source)) recordings.push_back(recording);
  for (const fs::path& recording : recordings) {
    const RosTopicIndex survey = index_recording(recording);
    if (recordings.size() > 1) std::cout << recording.string() << ":\n";
    for (const std::string& warning : survey.warnings) std::cout << "note: " << warning << '\n';
    for (const RosTopic& topic : survey.topics)
      std::cout << topic.name << "  " << topic.type << "  " << topic.messages << '\n';
  }
}

/// Reads the ranges of a recording, and notes which of its topics no robot uses.
void add_ranges_and_rest(const std::string& recording, const std::vector<RosSource>& sources,
                         const std::vector<RosImport>& team, RosRangeRequest request, TeamOutput& output) {
  std::set<std::string> used;
  const RosTopicIndex* index = nullptr;
  for (std::size_t k = 0; k < sources.size(); ++k) {
    if (sources[k].recording != recording) continue;
    request.own = index == nullptr ? sources[k].robot : "";
    index = &team[k].index;
    used.insert(team[k].topics.begin(), team[k].topics.end());
  }
  const RosRanges ranges = read_ros_ranges(recording, *index, request);
  output.add_ranges(ranges.ranges);
  if (!ranges.topics.empty())
    output.note(recording + ": " + std::to_string(ranges.ranges.size()) + " ranges of " +
                std::to_string(ranges.topics.size()) + " topics");
  for (const std::string& warning : ranges.warnings) output.note(warning);
  std::vector<RosTopic> left;
  for (const RosTopic& topic : index->topics)
    if (!used.contains(topic.name) && !ranges.topics.contains(topic.name) &&
        !is_transforms_type(topic.type) && !may_have_ranges(topic))
      left.push_back(topic);
  if (!left.empty()) output.note(recording + ": topics that are not imported: " + list_of_topics(left));
}

/// A summary of the imported data: "177 scans, 345 odometry samples, ... of a".
std::string ros_summary(const RosImport& imported) {
  const Robot& robot = imported.imported.mission.robots.front();
  std::string summary = std::to_string(imported.scans) + " scans, " + std::to_string(robot.odometry.size()) +
                        " odometry samples, " + std::to_string(robot.inertial.size()) + " IMU samples";
  if (!robot.fixes.empty()) summary += ", " + std::to_string(robot.fixes.size()) + " position fixes";
  if (!imported.wifi.rows.empty()) summary += ", " + wifi_summary(imported.wifi.rows);
  if (!imported.imported.truth.robots.empty())
    summary += ", " + std::to_string(imported.imported.truth.robots.front().poses.size()) + " true poses";
  return summary + " of " + robot.id;
}

}  // namespace

void import_carmen_logs(const ImportOptions& options) {
  const auto params = params_of<CarmenParams>(options);
  const std::vector<std::string> robots =
      robots_of_import(options, options.sources.size(), robot_letters(options.sources.size()));
  TeamOutput output(options, robots);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    ImportedMission imported = read_carmen(read_compressed_text(options.sources[k]), robots[k], params);
    const std::size_t scans = imported.mission.robots.front().lidar.size();
    output.add(std::move(imported), std::to_string(scans) + " scans and odometry of " + robots[k]);
  }
  output.commit();
}

void import_kitti_drives(const ImportOptions& options) {
  const std::vector<std::string> robots =
      robots_of_import(options, options.sources.size(), robot_letters(options.sources.size()));
  TeamOutput output(options, robots);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    KittiDrive drive = read_kitti_drive(options.sources[k], robots[k],
                                        value_for(options.poses, "--poses", k, robots.size()));
    copy_kitti_scans(drive, output.scans_of(robots[k]));
    const bool has_truth = !drive.imported.truth.robots.empty();
    output.add(std::move(drive.imported), std::to_string(drive.scans.size()) + " scans of " + robots[k] +
                                              (has_truth ? ", with ground truth" : ", without ground truth"));
  }
  output.commit();
}

void import_ros_recordings(const ImportOptions& options) {
  if (options.list) return list_topics(options);
  const std::vector<RosSource> sources = ros_sources(options);
  const RosRangeRequest request = ros_range_request(options, sources);
  std::vector<std::string> robots;
  for (const RosSource& source : sources) robots.push_back(source.robot);
  TeamOutput output(options, robots);
  std::vector<RosImport> team;
  for (const RosSource& source : sources) {
    const fs::path folder = output.scans_of(source.robot);
    team.push_back(import_ros_recording(
        source.recording, source.robot, source.topics,
        [&](Stamp stamp, const LidarScan& scan) { write_lidar_scan(folder, stamp, scan); }));
  }
  place_fixes(team);
  for (RosImport& robot : team) {
    const std::string summary = ros_summary(robot), id = robot.imported.mission.robots.front().id;
    if (!robot.wifi.rows.empty())
      write_file(output.folder_of(id) / "wifi.csv", format_wifi_rows(robot.wifi.rows));
    for (const auto& [what, count] : robot.wifi.counts) output.note(std::to_string(count) + ' ' + what);
    output.add(std::move(robot.imported), summary);
  }
  std::set<std::string> recordings;
  for (const RosSource& source : sources)
    if (recordings.insert(source.recording).second)
      add_ranges_and_rest(source.recording, sources, team, request, output);
  output.commit();
}

}  // namespace radioslam::cli
