#include "radioslam/io/datasets/wifine.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

namespace radioslam {
namespace {

constexpr double kUnheard_dbm = -100;

/// One row.
struct WifineRow {
  WifiScan scan;
  Eigen::Vector3d position_m;
};

/// Reads one trajectory.
class WifineReader {
 public:
  explicit WifineReader(const Text& text) : text_(text), csv_(text) { check_header(); }

  std::size_t access_points() const { return access_points_; }

  std::vector<WifineRow> read(std::vector<std::string>& warnings) {
    std::vector<WifineRow> rows;
    std::vector<std::size_t> lines;
    SkippedRecords skipped;
    for (bool is_row = true; is_row;)
      skipped.attempt([&] {
        is_row = csv_.next();
        if (!is_row) return;
        rows.push_back(read_row());
        lines.push_back(csv_.at().number());
      });
    const std::size_t read = rows.size();
    sort_records(
        rows, [](const WifineRow& row) { return row.scan.stamp; },
        [&](std::size_t row) { return InputError(text_.name, lines[row], "time runs backwards"); }, skipped);
    const auto same = [](const WifineRow& a, const WifineRow& b) { return a.scan.stamp == b.scan.stamp; };
    const auto end = std::unique(rows.begin(), rows.end(), same);
    for (auto row = end; row != rows.end(); ++row)
      skipped.add(InputError(text_.name, 0, "a second row of the same time"));
    rows.erase(end, rows.end());
    skipped.conclude(text_.name, "row", read, warnings);
    if (rows.empty()) text_.fail(1, "the file has no rows");
    return rows;
  }

 private:
  void check_header() {
    const auto& names = csv_.names();
    while (access_points_ < names.size() && names[access_points_] == std::to_string(access_points_))
      ++access_points_;
    const std::vector<std::string_view> expected{"num_visible_APs", "timestamp", "x", "y", "z", "floorID"};
    if (access_points_ == 0 || !std::equal(names.begin() + static_cast<std::ptrdiff_t>(access_points_),
                                           names.end(), expected.begin(), expected.end()))
      csv_.fail("the header is not that of WiFine: 0,1,...,num_visible_APs,timestamp,x,y,z,floorID");
  }

  WifineRow read_row() const {
    const std::size_t visible = access_points_, stamp = visible + 1, x = visible + 2;
    WifineRow row;
    row.scan.stamp = csv_.stamp(stamp);
    for (int axis = 0; axis < 3; ++axis)
      row.position_m[axis] = csv_.coordinate(x + static_cast<std::size_t>(axis));
    for (std::size_t k = 0; k < access_points_; ++k) add_reading(k, row.scan);
    if (parse_integer(csv_.field(visible)) != static_cast<std::int64_t>(row.scan.readings.size()))
      csv_.fail("num_visible_APs is " + std::string(csv_.field(visible)) + ", but " +
                std::to_string(row.scan.readings.size()) + " were received");
    return row;
  }

  void add_reading(std::size_t column, WifiScan& scan) const {
    const double rssi_dbm = number_in(csv_.at(), csv_.field(column), "a level");
    if (rssi_dbm == kUnheard_dbm) return;
    if (!is_plausible_rssi(rssi_dbm)) csv_.fail("the level " + format_number(rssi_dbm) + " is implausible");
    scan.readings.push_back({AccessPointIndex(column), 0, static_cast<float>(rssi_dbm)});
  }

  const Text& text_;
  CsvReader csv_;
  std::size_t access_points_ = 0;
};

/// "ap007" of 436: padded with zeros so that names sort in the order of columns.
std::vector<std::string> names_of_columns(std::size_t columns) {
  const std::size_t width = std::to_string(columns - 1).size();
  std::vector<std::string> names;
  for (std::size_t k = 0; k < columns; ++k) {
    const std::string number = std::to_string(k);
    names.push_back("ap" + std::string(width - number.size(), '0') + number);
  }
  return names;
}

void add_trajectory(const std::string& id, std::vector<WifineRow> rows, ImportedMission& imported) {
  Robot& robot = imported.mission.robots.emplace_back();
  robot.id = id;
  std::vector<StampedPose<SE3>> poses;
  for (WifineRow& row : rows) {
    poses.push_back({row.scan.stamp, SE3(row.position_m, Eigen::Quaterniond::Identity())});
    if (!row.scan.readings.empty()) robot.wifi.push_back(std::move(row.scan));
  }
  imported.truth.robots.push_back({id, Trajectory<SE3>(std::move(poses)), false});
}

}  // namespace

ImportedMission mission_of_wifine(const std::vector<NamedWifineFile>& files, const std::string& name) {
  ImportedMission imported;
  imported.mission.name = name;
  imported.mission.dimension = 3;
  SkippedRecords bad;
  for (const NamedWifineFile& file : files) {
    bad.attempt([&] {
      WifineReader reader(file.text);
      auto& names = imported.mission.access_points;
      if (!names.empty() && names.size() != reader.access_points())
        file.text.fail(1, "has other access points than the previous files");
      std::vector<WifineRow> rows = reader.read(imported.warnings);
      names = names_of_columns(reader.access_points());
      add_trajectory(file.id, std::move(rows), imported);
    });
  }
  bad.conclude(name, "file", imported.mission.robots.size(), imported.warnings);
  return imported;
}

ImportedMission import_wifine(const std::filesystem::path& source) {
  std::vector<NamedWifineFile> files;
  for (const auto& path : find_csv_files(source))
    files.push_back({path.stem().string(), read_tool_output(path)});
  return mission_of_wifine(files, name_of_source(source));
}

}  // namespace radioslam
