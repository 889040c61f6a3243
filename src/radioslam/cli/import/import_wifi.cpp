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
#include "radioslam/cli/import/wifi_summary.hpp"
#include "radioslam/io/mission/mission_output.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/skipped_records.hpp"
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

// Output of imported WiFi scans: a wifi.csv alone, or the wifi.csv of a robot in a mission.

/// One of three targets, depending on the output path:
///   NAME.csv              the table alone
///   an existing mission   robots/<robot>/wifi.csv, of a robot that is added if it is not there; the robot
///   need
///                         not be named if there is only one
///   any other folder      a new mission of one robot without odometry; without a name, the robot is named
///                         after the source
class WifiCsvOutput {
 public:
  explicit WifiCsvOutput(const ImportOptions& options) : options_(options) {
    if (options.output.ends_with(".csv")) {
      if (!options.robot.empty()) check_import_id("--robot " + options.robot, options.robot);
      refuse_table_of_mission(options);
      file_.emplace(options.output);
    } else {
      robot_ = robot_of_import(options);
      mission_.emplace(options.output, existing_of(options));
    }
  }

  void commit(const std::vector<WifiRow>& rows) {
    const std::string table = format_wifi_rows(rows);
    if (file_) return file_->commit(table);
    Mission mission;
    mission.name = name_of_source(options_.output);
    mission.robots.emplace_back().id = robot_.id;
    write_file(mission_->folder_of(robot_.id) / "wifi.csv", table);
    mission_->commit(mission);
  }

  /// The path that commit() may replace.
  std::string replaced() const {
    const fs::path mission = options_.output;
    const bool grows = !file_ && fs::exists(mission / kMissionFolder);
    return grows ? (mission / "robots" / robot_.id / "wifi.csv").string() : options_.output;
  }

  /// The robot's name; empty for a table alone.
  const std::string& robot() const { return robot_.id; }
  /// What the user should know of the mission.
  std::vector<std::string> notes() const {
    return file_ ? std::vector<std::string>{} : notes_on(options_, robot_);
  }

 private:
  const ImportOptions& options_;
  ImportedRobot robot_;
  std::optional<OutputFile> file_;
  std::optional<MissionOutput> mission_;
};

/// All source files: sources that are files, and the files in sources that are folders, sorted by name. In
/// folders only files with one of `extensions` count; if it is empty, all do.
std::vector<fs::path> files_of(const ImportOptions& options, const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const std::string& source : options.sources) {
    if (!fs::exists(source)) throw InputError(source, 0, "no such file");
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

void write_wifi(const ImportOptions& options, WifiCsvOutput& target, std::vector<WifiLog> logs) {
  const WifiLog log = join_wifi_logs(std::move(logs));
  if (log.rows.empty()) {
    std::string why;
    for (const auto& [what, count] : log.counts) why += "; " + std::to_string(count) + " " + what;
    throw InputError(options.sources.front(), 0, "has no signal strengths" + why);
  }
  target.commit(log.rows);
  print_notes(log);
  for (const std::string& note : target.notes()) std::cout << "note: " << note << '\n';
  std::cout << options.output << ": " << wifi_summary(log.rows)
            << (target.robot().empty() ? "" : " of " + target.robot()) << '\n';
}

/// Opens the output. Refuses one that would replace an input.
std::unique_ptr<WifiCsvOutput> target_of(const ImportOptions& options, const std::vector<fs::path>& files) {
  auto target = std::make_unique<WifiCsvOutput>(options);
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
  if (const auto note = control_character_note(text)) log.warnings.push_back(*note);
  const auto time = time_of_file(options, file, files);
  const bool is_timed = std::any_of(log.scans.begin(), log.scans.end(), [](const ScanList& scan) {
    return scan.stamp.has_value() || !scan.unread_time.empty();
  });
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

/// Reads every file by `read`; a refused one of several is left out with a warning in a log of its own.
template <class Log, class Read>
std::vector<Log> read_files(const ImportOptions& options, std::vector<fs::path>& files, const Read& read) {
  std::vector<Log> logs;
  SkippedRecords bad;
  std::vector<fs::path> used;
  for (const fs::path& file : files)
    if (bad.attempt([&] { logs.push_back(read(file)); })) used.push_back(file);
  std::vector<std::string> warnings;
  bad.conclude(options.sources.front(), "file", used.size(), warnings);
  if (!warnings.empty()) logs.front().warnings.push_back(warnings.front());
  files = std::move(used);
  return logs;
}

}  // namespace

void import_printed_scans(const ImportOptions& options) {
  const auto params = params_of<ScanListParams>(options);
  auto files = files_of(options, {});
  const auto target = target_of(options, files);
  const std::size_t count = files.size();
  std::vector<ScanListLog> logs = read_files<ScanListLog>(
      options, files, [&](const fs::path& file) { return read_list_file(options, file, count); });
  refuse_two_clocks(files, logs);
  write_wifi(options, *target, {rows_of_scans(std::move(logs), params)});
}

void import_airodump(const ImportOptions& options) {
  const auto params = params_of<AirodumpParams>(options);
  std::vector<fs::path> files(options.sources.begin(), options.sources.end());
  for (const fs::path& file : files)
    if (!fs::exists(file)) throw InputError(file.string(), 0, "no such file");
  const auto target = target_of(options, files);
  write_wifi(options, *target, read_files<WifiLog>(options, files, [&](const fs::path& file) {
               const Text text = read_tool_output(file);
               WifiLog log = read_airodump(text, params);
               if (const auto note = control_character_note(text)) log.warnings.push_back(*note);
               return log;
             }));
}

void import_wifi_captures(const ImportOptions& options) {
  const auto params = params_of<WifiCaptureParams>(options);
  auto files = files_of(options, {".pcap", ".pcapng", ".cap"});
  const auto target = target_of(options, files);
  write_wifi(options, *target, read_files<WifiLog>(options, files, [&](const fs::path& file) {
               return read_wifi_capture(file, params);
             }));
}

}  // namespace radioslam::cli
