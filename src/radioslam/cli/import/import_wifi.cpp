#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/import/import_commands.hpp"
#include "radioslam/cli/import/import_options.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/airodump_csv.hpp"
#include "radioslam/io/wifi/iw_scan.hpp"
#include "radioslam/io/wifi/iwlist_scan.hpp"
#include "radioslam/io/wifi/log_time.hpp"
#include "radioslam/io/wifi/nmcli_list.hpp"
#include "radioslam/io/wifi/wifi_capture.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> robots_in_mission(const fs::path& mission) {
  std::vector<std::string> ids;
  for (const Robot& robot : read_mission_yaml(read_text(mission / kMissionFolder), "").mission.robots)
    ids.push_back(robot.id);
  return ids;
}

// Output of imported WiFi scans: a wifi.csv alone, or the wifi.csv of a robot in a mission.

/// One of three targets, depending on the output path:
///   NAME.csv              the table alone
///   an existing mission   robots/<robot>/wifi.csv; the robot need not be named if there is only one
///   any other folder      a new mission of one robot without odometry; without a name, the robot is named
///                         after the source
class WifiCsvOutput {
 public:
  /// Refuses (InputError) a robot that the mission does not have, and invalid names.
  WifiCsvOutput(const std::string& output, const std::string& robot, const std::string& source);

  void commit(const std::vector<WifiRow>& rows) {
    const std::string table = format_wifi_rows(rows);
    if (file_) return file_->commit(table);
    Mission mission;
    mission.name = name_of_source(output_);
    mission.robots.emplace_back().id = robot_;
    write_mission(folder_->path(), mission);
    write_file(folder_->path() / "robots" / robot_ / "wifi.csv", table);
    folder_->commit();
  }

  /// The path that commit() replaces.
  std::string replaced() const { return file_ ? table_ : output_; }

  /// The robot's name; empty for a table alone.
  const std::string& robot() const { return robot_; }
  /// A note on what the mission still lacks before it can be run; empty if nothing is known to be missing.
  std::string missing() const {
    if (robot_.empty() || output_.ends_with(".csv")) return {};
    const std::string odometry = file_of_robot("odometry.tum");
    return fs::exists(odometry) ? "" : odometry + " is missing; `radioslam run` needs it";
  }

 private:
  void find_robot_of_mission() {
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

  void name_robot_after(const std::string& source) {
    robot_ = name_of_source(source);
    if (!is_valid_id(robot_))
      throw InputError(source, 0, "its name is not a valid robot name; --robot sets another one");
  }

  std::string file_of_robot(const char* name) const {
    return (fs::path(output_) / "robots" / robot_ / name).string();
  }

  std::string output_, robot_;
  std::string table_;  ///< the path of file_
  std::optional<OutputFile> file_;
  std::optional<OutputFolder> folder_;
};

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

/// All source files: sources that are files, and the files in sources that are folders, sorted by name. In
/// folders only files with one of `extensions` count; if it is empty, all do.
std::vector<fs::path> files_of(const ImportOptions& options, const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const std::string& source : options.sources) {
    if (!fs::is_directory(source)) {
      files.emplace_back(source);
      continue;
    }
    const std::vector<fs::path> inside = files_in(source, Depth::kBelow, [&](const fs::path& file) {
      const bool is_meant = extensions.empty() ||
                            std::count(extensions.begin(), extensions.end(), file.extension().string()) > 0;
      return is_meant && !is_hidden(file);
    });
    if (inside.empty()) throw InputError(source, 0, "has no files to import");
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

void print_notes(const WifiLog& log) {
  for (const std::string& warning : log.warnings) std::cout << "note: " << warning << '\n';
  for (const auto& [what, count] : log.counts) std::cout << "note: " << count << ' ' << what << '\n';
}

/// "12 rows, 3 scans, 5 radios", and the robot's name if known.
std::string wifi_summary(const WifiLog& log, const WifiCsvOutput& target) {
  std::set<std::string> radios;
  std::set<Stamp> scans;
  for (const WifiRow& row : log.rows) {
    radios.insert(row.bssid);
    scans.insert(row.stamp);
  }
  const std::string counts = std::to_string(log.rows.size()) + " rows, " + std::to_string(scans.size()) +
                             " scans, " + std::to_string(radios.size()) + " radios";
  return counts + (target.robot().empty() ? "" : " of " + target.robot());
}

void write_wifi(const ImportOptions& options, WifiCsvOutput& target, std::vector<WifiLog> logs) {
  const WifiLog log = join_wifi_logs(std::move(logs));
  if (log.rows.empty()) {
    std::string why;
    for (const auto& [what, count] : log.counts) why += "; " + std::to_string(count) + " " + what;
    throw InputError(options.sources.front(), 0, "has no signal strengths" + why);
  }
  target.commit(log.rows);
  print_notes(log);
  if (const std::string missing = target.missing(); !missing.empty())
    std::cout << "note: " << missing << '\n';
  std::cout << options.output << ": " << wifi_summary(log, target) << '\n';
}

/// Opens the output. Refuses one that would replace an input.
std::unique_ptr<WifiCsvOutput> target_of(const ImportOptions& options, const std::vector<fs::path>& files) {
  auto target = std::make_unique<WifiCsvOutput>(options.output, options.robot, options.sources.front());
  refuse_replacing_inputs(target->replaced(), {files.begin(), files.end()});
  return target;
}

/// The time of a file whose scans have none; nothing if it is unknown.
std::optional<GivenTime> time_of_file(const ImportOptions& options, const fs::path& file, std::size_t files) {
  if (!options.time.empty()) {
    const auto time = parse_time_line(options.time);
    if (!time)
      throw InputError("--time " + options.time, 0, "expected seconds, or ISO 8601 with a time zone");
    if (files > 1) throw InputError("--time " + options.time, 0, "applies to a single file");
    return GivenTime{*time};
  }
  if (options.file_times) return GivenTime{time_of_last_write(file), GivenTime::Of::kLast};
  const auto time = time_in_name(file.stem().string());
  return time ? std::optional(GivenTime{*time}) : std::nullopt;
}

ScanListLog read_list(const ImportOptions& options, const Text& text) {
  if (options.kind == "iw") return read_iw_scans(text);
  if (options.kind == "iwlist") return read_iwlist_scans(text);
  return read_nmcli_lists(
      text, options.fields.empty() ? default_nmcli_fields() : parse_nmcli_fields(options.fields));
}

ScanListLog read_list_file(const ImportOptions& options, const fs::path& file, std::size_t files) {
  if (files > 1 && fs::is_regular_file(file) && fs::is_empty(file))
    return {{}, {{"empty files of failed scans were skipped", 1}}, {}};
  const Text text = read_tool_output(file);
  ScanListLog log = read_list(options, text);
  const auto time = time_of_file(options, file, files);
  const bool is_timed = std::all_of(log.scans.begin(), log.scans.end(),
                                    [](const ScanList& scan) { return scan.stamp.has_value(); });
  if (files > 1 && !time && !is_timed)
    text.fail(0,
              "has no time, neither in a line before the scan nor in its name; --file-times uses its last "
              "modification");
  time_scans(text, log, time);
  return log;
}

/// Refuses a mix of files with seconds since boot and files with absolute times, which cannot be put in
/// order.
void refuse_two_clocks(const std::vector<fs::path>& files, const std::vector<ScanListLog>& logs) {
  std::optional<std::size_t> absolute, boot;
  for (std::size_t k = 0; k < logs.size(); ++k)
    if (const auto clock = clock_of(logs[k])) (clock == ScanListClock::kBoot ? boot : absolute) = k;
  if (absolute && boot)
    throw InputError(files[*boot].string(), 0,
                     "has only times since boot, but " + files[*absolute].string() +
                         " has absolute ones; give all of them a time by a line before each scan, by the "
                         "file's name or by --file-times");
}

}  // namespace

void import_printed_scans(const ImportOptions& options) {
  const auto params = params_of<ScanListParams>(options);
  const auto files = files_of(options, {});
  const auto target = target_of(options, files);
  std::vector<ScanListLog> logs;
  for (const fs::path& file : files) logs.push_back(read_list_file(options, file, files.size()));
  refuse_two_clocks(files, logs);
  write_wifi(options, *target, {rows_of_scans(std::move(logs), params)});
}

void import_airodump(const ImportOptions& options) {
  const auto params = params_of<AirodumpParams>(options);
  const auto target = target_of(options, {options.sources.begin(), options.sources.end()});
  std::vector<WifiLog> logs;
  for (const std::string& source : options.sources)
    logs.push_back(read_airodump(read_tool_output(source), params));
  write_wifi(options, *target, std::move(logs));
}

void import_wifi_captures(const ImportOptions& options) {
  const auto params = params_of<WifiCaptureParams>(options);
  const auto files = files_of(options, {".pcap", ".pcapng", ".cap"});
  const auto target = target_of(options, files);
  std::vector<WifiLog> logs;
  for (const fs::path& file : files) logs.push_back(read_wifi_capture(file, params));
  write_wifi(options, *target, std::move(logs));
}

}  // namespace radioslam::cli
