#include "radioslam/io/wifine.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/io/csv_files.hpp"
#include "radioslam/io/fields_of_line.hpp"
#include "radioslam/io/numbers.hpp"
#include "radioslam/io/quoted_row.hpp"
#include "radioslam/io/wifi_csv.hpp"

namespace radioslam {
namespace {

constexpr double kUnheard_dbm = -100;
constexpr std::size_t kOtherColumns = 6;  // num_visible_APs, timestamp, x, y, z, floorID

/// One row.
struct WifineRow {
  WifiScan scan;
  Eigen::Vector3d position_m;
};

/// Reads one trajectory.
class WifineReader {
 public:
  explicit WifineReader(const Text& text) : text_(text), lines_(text) { read_header(); }

  std::size_t access_points() const { return access_points_; }

  std::vector<WifineRow> read() {
    std::vector<WifineRow> rows;
    while (lines_.next_with_content()) {
      rows.push_back(read_row());
      if (rows.size() > 1 && rows.back().scan.stamp <= rows[rows.size() - 2].scan.stamp)
        lines_.fail("time does not run forward");
    }
    if (rows.empty()) text_.fail(1, "the file has no rows");
    return rows;
  }

 private:
  void read_header() {
    if (!lines_.next_with_content()) text_.fail(1, "the file has no header line");
    const auto names = split_quoted_row(lines_.line());
    while (access_points_ < names.size() && names[access_points_] == std::to_string(access_points_))
      ++access_points_;
    const std::vector<std::string_view> expected{"num_visible_APs", "timestamp", "x", "y", "z", "floorID"};
    if (access_points_ == 0 || !std::equal(names.begin() + static_cast<std::ptrdiff_t>(access_points_),
                                           names.end(), expected.begin(), expected.end()))
      lines_.fail("the header is not that of WiFine: 0,1,...,num_visible_APs,timestamp,x,y,z,floorID");
  }

  WifineRow read_row() {
    const auto fields = split_quoted_row(lines_.line());
    if (fields.size() != access_points_ + kOtherColumns)
      lines_.fail("the row has " + std::to_string(fields.size()) + " fields, the header " +
                  std::to_string(access_points_ + kOtherColumns));
    const std::string_view* other = fields.data() + access_points_;
    WifineRow row;
    row.scan.stamp = stamp_in(lines_, other[1], "timestamp");
    row.position_m = {coordinate_in(lines_, other[2], "x"), coordinate_in(lines_, other[3], "y"),
                      coordinate_in(lines_, other[4], "z")};
    for (std::size_t k = 0; k < access_points_; ++k) add_reading(fields[k], k, row.scan);
    if (parse_integer(other[0]) != static_cast<std::int64_t>(row.scan.readings.size()))
      lines_.fail("num_visible_APs " + std::string(other[0]) + ", and " +
                  std::to_string(row.scan.readings.size()) + " are heard");
    return row;
  }

  void add_reading(std::string_view field, std::size_t column, WifiScan& scan) const {
    const double rssi_dbm = number_in(lines_, field, "a level");
    if (rssi_dbm == kUnheard_dbm) return;
    if (!is_plausible_rssi(rssi_dbm)) lines_.fail("the level " + format_number(rssi_dbm) + " is implausible");
    scan.readings.push_back({AccessPointIndex(column), 0, static_cast<float>(rssi_dbm)});
  }

  const Text& text_;
  TextLines lines_;
  std::size_t access_points_ = 0;
};

/// "ap007" of 436, so that the order of names is that of columns.
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
  for (const NamedWifineFile& file : files) {
    WifineReader reader(file.text);
    auto& names = imported.mission.access_points;
    if (names.empty()) names = names_of_columns(reader.access_points());
    if (names.size() != reader.access_points())
      file.text.fail(1, "has other access points than the files before");
    add_trajectory(file.id, reader.read(), imported);
  }
  return imported;
}

ImportedMission import_wifine(const std::filesystem::path& source) {
  std::vector<NamedWifineFile> files;
  for (const auto& path : find_csv_files(source)) files.push_back({path.stem().string(), read_text(path)});
  return mission_of_wifine(files, name_of_source(source));
}

}  // namespace radioslam
