#include "radioslam/io/datasets/android_recording.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "radioslam/io/datasets/indoor_location.hpp"
#include "radioslam/io/datasets/walker_tables.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/wifi/phone_log.hpp"
#include "radioslam/io/wifi/sensor_data_log.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

/// The sources' texts by what they are.
struct Texts {
  std::vector<Text> scans, motion, logs;
  std::vector<std::string> unused;
};

void sort_in(Text text, bool is_named, Texts& texts) {
  if (is_phone_log(text) || is_sensor_data_log(text))
    texts.logs.push_back(std::move(text));
  else if (is_scan_table(text))
    texts.scans.push_back(std::move(text));
  else if (is_walker_table(text))
    texts.motion.push_back(std::move(text));
  else if (is_named)
    text.fail(0, "is neither a table of WiFi scans nor one of an accelerometer or a gyroscope, nor a log");
  else
    texts.unused.push_back(fs::path(text.name).filename().string());
}

Texts read_sources(const std::vector<fs::path>& sources) {
  static const std::set<std::string> kExtensions{".csv", ".txt", ".log", ".tsv"};
  Texts texts;
  for (const fs::path& source : sources) {
    if (!fs::is_directory(source)) {
      sort_in(read_tool_output(source), true, texts);
      continue;
    }
    for (const fs::path& file : files_in(source, Depth::kBelow, [](const fs::path& file) {
           return kExtensions.contains(lower_case(file.extension().string())) && !is_hidden(file);
         }))
      if (!fs::is_empty(file)) sort_in(read_tool_output(file), false, texts);
  }
  return texts;
}

/// Leaves the best tables of one sensor: those with gravity, calibrated, of the phone itself.
void choose_tables(std::vector<Text>& tables) {
  const auto named = [](const Text& table, const char* word) {
    return lower_case(fs::path(table.name).stem().string()).find(word) != std::string::npos;
  };
  for (const char* other : {"watch", "wrist", "headphone", "linear"})
    std::erase_if(tables, [&](const Text& table) { return named(table, other); });
  const auto has = [&](const char* word, const char* without) {
    return std::any_of(tables.begin(), tables.end(),
                       [&](const Text& table) { return named(table, word) && !named(table, without); });
  };
  if (has("total", "uncalibrated"))
    std::erase_if(tables, [&](const Text& table) {
      return !named(table, "total") && (named(table, "acc") || named(table, "gravity"));
    });
  for (const char* sensor : {"acc", "gyr"})
    if (has(sensor, "uncalibrated"))
      std::erase_if(tables,
                    [&](const Text& table) { return named(table, sensor) && named(table, "uncalibrated"); });
}

/// The readings of a log since it began; those from before are left over from an earlier recording.
WifiLog rows_of(const PhoneLog& log, double clock_offset_s) {
  WifiLog wifi;
  for (const ScanEntry& entry : log.wifi)
    if (std::abs(entry.scan.seconds()) > kLatestTime_s)
      ++wifi.counts["readings have an impossible time and are left out"];
    else if (entry.last_seen < log.start)
      ++wifi.counts["readings are from before the recording and left out"];
    else
      wifi.rows.push_back(
          {on_clock_ahead_by(clock_offset_s, entry.scan), entry.bssid, entry.frequency_mhz, entry.rssi_dbm});
  return wifi;
}

/// Motion and its interval.
struct Walk {
  PhoneMotion motion;
  Stamp begin, end;
};

bool has_both_sensors(const PhoneMotion& motion) {
  return !motion.specific_force_mps2.empty() && !motion.angular_rate_radps.empty();
}

Walk walk_of_tables(const std::vector<Text>& tables, std::vector<std::string>& warnings) {
  Walk walk{read_walker_imu(tables, warnings), {}, {}};
  const auto &forces = walk.motion.specific_force_mps2, &rates = walk.motion.angular_rate_radps;
  walk.begin = std::min(forces.front().stamp, rates.front().stamp);
  walk.end = std::max(forces.back().stamp, rates.back().stamp);
  if (walk.end <= walk.begin) tables.front().fail(0, "all samples have the same time");
  return walk;
}

void refuse_other_clock(const Walk& walk, const WifiLog& wifi, const fs::path& source) {
  if (wifi.rows.empty() || std::any_of(wifi.rows.begin(), wifi.rows.end(), [&](const WifiRow& row) {
        return walk.begin <= row.stamp && row.stamp <= walk.end;
      }))
    return;
  throw InputError(source.string(), 0,
                   "none of the WiFi scans, the first at " + format_stamp(wifi.rows.front().stamp) +
                       " s, is within the time of the motion, " + format_stamp(walk.begin) + " to " +
                       format_stamp(walk.end) +
                       " s; --set scans.clock_offset_s=SECONDS moves the scans to the clock of the motion",
                   InputError::Kind::kClock);
}

void add_odometry(const Walk& walk, const DeadReckoningParams& params, AndroidRecording& recording) {
  DeadReckoning reckoned = dead_reckon(walk.motion, walk.begin, walk.end, params);
  if (reckoned.steps.empty()) recording.warnings.push_back("no steps detected; the robot does not move");
  recording.steps = reckoned.steps.size();
  set_walk(recording.robot, std::move(reckoned));
}

/// The only log of the sources, if they have one.
std::optional<PhoneLog> log_of(const std::vector<Text>& logs) {
  if (logs.size() > 1)
    logs[1].fail(0, "is a second log; a robot has one, and --robot names another robot",
                 InputError::Kind::kDuplicate);
  if (logs.empty()) return std::nullopt;
  return is_sensor_data_log(logs.front()) ? read_sensor_data_log(logs.front()) : read_phone_log(logs.front());
}

}  // namespace

AndroidRecording read_android_recording(const std::vector<fs::path>& sources, const AndroidParams& params) {
  Texts texts = read_sources(sources);
  choose_tables(texts.motion);
  AndroidRecording recording;
  std::vector<WifiLog> scans;
  for (const Text& table : texts.scans) scans.push_back(read_scan_table(table, params.scans));
  std::optional<Walk> walk;
  if (auto log = log_of(texts.logs)) {
    scans.push_back(rows_of(*log, params.scans.clock_offset_s));
    recording.truth = waypoints_of(*log);
    recording.warnings = std::move(log->warnings);
    if (has_both_sensors(log->motion)) walk = Walk{std::move(log->motion), log->begin, log->end};
  }
  if (walk && !texts.motion.empty())
    texts.motion.front().fail(0, "is of a sensor that " + texts.logs.front().name + " has, too",
                              InputError::Kind::kDuplicate);
  if (!walk && !texts.motion.empty()) walk = walk_of_tables(texts.motion, recording.warnings);
  recording.wifi = join_wifi_logs(std::move(scans));
  if (!walk && recording.wifi.rows.empty())
    throw InputError(sources.front().string(), 0, "has neither WiFi scans nor motion of a phone to import");
  if (walk) {
    refuse_other_clock(*walk, recording.wifi, sources.front());
    add_odometry(*walk, params.walk, recording);
  }
  if (!texts.unused.empty()) {
    std::string list;
    for (const std::string& name : texts.unused) list += (list.empty() ? "" : ", ") + name;
    recording.warnings.push_back("files that are not used: " + list);
  }
  return recording;
}

}  // namespace radioslam
