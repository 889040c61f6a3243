#include "radioslam/io/datasets/wifi_rtt.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kPhoneTime = " Time Stamp (ms)", kBetweenHead = "Time Stamp (ms),M1-M2 RTT",
                           kAnchorsHead = ",x,y", kPhoneTruth = " Ground Truth";
constexpr std::size_t kColumnsPerAnchor = 4;  // true distance, measured distance, spread, level
constexpr double kMaxTime_ms = 1e12;
constexpr const char* kTooFar = "distances are implausible and left out";

/// The stamp in the first column, in milliseconds.
Stamp stamp_in_ms(const CsvReader& table) {
  const double ms = table.number(0);
  if (ms < 0 || ms > kMaxTime_ms) table.fail("the time is implausible");
  return Stamp::from_seconds(ms * kSecondsPerMillisecond);
}

/// Builds a mission from the files.
class RttMission {
 public:
  RttMission(std::string name, const WifiRttParams& params) : params_(params) {
    imported_.mission.name = std::move(name);
  }

  void add_anchors(const Text& text) {
    CsvReader table(text);
    const std::size_t x = table.column("x"), y = table.column("y");
    for_each_row(text, table, [&] {
      const std::string id(table.field(0));
      const Eigen::Vector3d position(table.number(x), table.number(y), 0);
      imported_.mission.anchors[anchor(id).index()].position_m = position;
    });
  }

  void add_phone(const Text& text) {
    CsvReader table(text);
    const std::string id(table.names()[0].substr(0, table.names()[0].size() - kPhoneTime.size()));
    const RobotIndex robot(imported_.mission.robots.size());
    imported_.mission.robots.emplace_back().id = id;
    const auto columns = anchor_columns(table);
    const std::size_t truth = table.column(id + std::string(kPhoneTruth));
    std::vector<TrajectoryRow> rows;
    for_each_row(text, table, [&] {
      const Stamp stamp = stamp_in_ms(table);
      const SE3 place(position(table, truth), Eigen::Quaterniond::Identity());
      const WifiScan scan = scan_in(table, columns, stamp);
      for (const auto& [anchor_id, column] : columns)
        add_range(table, column + 1, stamp, robot, {RobotIndex{}, anchor(anchor_id), {}});
      if (!scan.readings.empty()) imported_.mission.robots.back().wifi.push_back(scan);
      if (rows.empty() || rows.back().pose.stamp != stamp)
        rows.push_back({{stamp, place}, table.at().number()});
    });
    if (rows.empty()) table.fail("the file has no rows");
    auto& scans = imported_.mission.robots.back().wifi;
    std::stable_sort(scans.begin(), scans.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    imported_.truth.robots.push_back({id, trajectory_of_rows(text, rows, imported_.warnings), false});
  }

  void add_between(const Text& text) {
    CsvReader table(text);
    if (imported_.mission.robots.size() < 2)
      text.fail(1, "has ranges between two phones, but only one of them has a file");
    for_each_row(text, table, [&] {
      add_range(table, 1, stamp_in_ms(table), RobotIndex(std::size_t{0}),
                {RobotIndex(std::size_t{1}), {}, {}});
    });
  }

  ImportedMission take() {
    auto& ranges = imported_.mission.ranges;
    std::stable_sort(ranges.begin(), ranges.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    if (implausible_ > 0) imported_.warnings.push_back(std::to_string(implausible_) + " " + kTooFar);
    return std::move(imported_);
  }

 private:
  using AnchorColumns = std::vector<std::pair<std::string, std::size_t>>;

  /// Reads all rows; bad ones are left out with a warning.
  template <class Read>
  void for_each_row(const Text& text, CsvReader& table, const Read& read) {
    SkippedRecords skipped;
    std::size_t used = 0;
    bool is_row = true;
    const auto read_next = [&] {
      is_row = table.next();
      if (!is_row) return;
      read();
      ++used;
    };
    while (is_row) skipped.attempt(read_next);
    skipped.conclude(text.name, "row", used, imported_.warnings);
  }

  AnchorIndex anchor(const std::string& id) {
    auto& anchors = imported_.mission.anchors;
    for (std::size_t k = 0; k < anchors.size(); ++k)
      if (anchors[k].id == id) return AnchorIndex(k);
    anchors.push_back({id, std::nullopt, 0});
    imported_.mission.access_points.push_back(lower_case(id));
    return AnchorIndex(anchors.size() - 1);
  }

  /// The names of the access points and their first columns.
  AnchorColumns anchor_columns(const CsvReader& table) {
    constexpr std::string_view kFirstOfAnchor = " True Distance (m)";
    AnchorColumns columns;
    for (std::size_t k = 1; k + kColumnsPerAnchor <= table.names().size(); k += kColumnsPerAnchor) {
      if (!table.names()[k].ends_with(kFirstOfAnchor)) break;
      const std::string id(table.names()[k].substr(0, table.names()[k].size() - kFirstOfAnchor.size()));
      if (table.names()[k + 1] != id + " RTT Distance (m)" || table.names()[k + 2] != id + " RTT std (m)" ||
          table.names()[k + 3] != id + " RSS (dBm)")
        table.fail("distance, std and RSS of " + id + " must follow its true distance");
      columns.emplace_back(id, k);
      anchor(id);
    }
    if (columns.empty()) table.fail("the file has no columns of an access point");
    return columns;
  }

  WifiScan scan_in(const CsvReader& table, const AnchorColumns& columns, Stamp stamp) {
    WifiScan scan{stamp, {}};
    for (const auto& [id, column] : columns) {
      const double rssi_dbm = table.number(column + kColumnsPerAnchor - 1);
      if (rssi_dbm == 0) continue;
      if (!is_plausible_rssi(rssi_dbm)) table.fail("the level of " + id + " is implausible");
      scan.readings.push_back({AccessPointIndex(anchor(id).index()), 0, static_cast<float>(rssi_dbm)});
    }
    return scan;
  }

  /// The distance in `column` and its spread in the next one.
  void add_range(const CsvReader& table, std::size_t column, Stamp stamp, RobotIndex robot, LinkEnd other) {
    const double range_m = table.number(column), spread_m = table.number(column + 1);
    if (range_m == 0) return;
    if (range_m < 0 || range_m > params_.max_range_m || spread_m < 0) {
      ++implausible_;
      return;
    }
    const double sigma_m = spread_m == 0 ? params_.nominal_sigma_m : std::max(spread_m, params_.min_sigma_m);
    RangeMeasurement range{stamp, {}, std::move(other), range_m, sigma_m};
    range.i.robot = robot;
    imported_.mission.ranges.push_back(std::move(range));
  }

  /// "[22.995, 11.15]"
  static Eigen::Vector3d position(const CsvReader& table, std::size_t column) {
    const std::string_view text = table.field(column);
    const std::size_t comma = text.find(',');
    if (!text.starts_with('[') || !text.ends_with(']') || comma == std::string_view::npos)
      table.fail("the ground truth is not of the form [x, y]");
    return {coordinate_in(table.at(), trim(text.substr(1, comma - 1)), "x"),
            coordinate_in(table.at(), trim(text.substr(comma + 1, text.size() - comma - 2)), "y"), 0};
  }

  WifiRttParams params_;
  ImportedMission imported_;
  std::size_t implausible_ = 0;
};

std::vector<std::filesystem::path> csv_files_in(const std::filesystem::path& folder) {
  return files_in(folder, Depth::kFolder,
                  [](const std::filesystem::path& file) { return file.extension() == ".csv"; });
}

std::string_view first_line(const Text& text) {
  TextLines lines(text);
  lines.next();
  return trim(lines.line());
}

void keep_only_one(std::optional<Text>& kept, Text text) {
  if (kept) text.fail(1, "is a second file of the same kind as " + kept->name);
  kept = std::move(text);
}

void sort_in(Text text, std::map<std::string, Text>& phones, WifiRttFiles& files) {
  const std::string_view head = first_line(text);
  const std::string_view first = head.substr(0, head.find(','));
  if (head.starts_with(kBetweenHead))
    keep_only_one(files.between, std::move(text));
  else if (head == kAnchorsHead)
    keep_only_one(files.anchors, std::move(text));
  else if (first.size() > kPhoneTime.size() && first.ends_with(kPhoneTime)) {
    const std::string name = text.name;
    if (!phones.emplace(std::string(first), std::move(text)).second)
      throw InputError(name, 1, "is a second file of the same phone");
  }
}

}  // namespace

ImportedMission mission_of_wifi_rtt(const WifiRttFiles& files, const std::string& name,
                                    const WifiRttParams& params) {
  RttMission mission(name, params);
  if (files.anchors) mission.add_anchors(*files.anchors);
  for (const Text& phone : files.phones) mission.add_phone(phone);
  if (files.between) mission.add_between(*files.between);
  return mission.take();
}

ImportedMission import_wifi_rtt(const std::filesystem::path& source, const WifiRttParams& params) {
  if (!std::filesystem::is_directory(source))
    throw InputError(source.string(), 0, "is not a folder; a walk of two phones is one");
  WifiRttFiles files;
  std::map<std::string, Text> phones;
  for (const auto& path : csv_files_in(source)) sort_in(read_tool_output(path), phones, files);
  const auto above = std::filesystem::absolute(source).lexically_normal() / "..";
  if (!files.anchors)
    for (const auto& path : csv_files_in(above.lexically_normal())) {
      Text text = read_tool_output(path);
      if (first_line(text) == kAnchorsHead) keep_only_one(files.anchors, std::move(text));
    }
  if (phones.empty())
    throw InputError(source.string(), 0, "contains no file of a phone (M1 Time Stamp (ms),AP1 ...)");
  for (auto& phone : phones) files.phones.push_back(std::move(phone.second));
  return mission_of_wifi_rtt(files, name_of_source(source), params);
}

}  // namespace radioslam
