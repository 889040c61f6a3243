#include "radioslam/io/team_tables.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "radioslam/io/csv.hpp"
#include "radioslam/io/fields_of_line.hpp"

namespace radioslam {
namespace {

/// What a column holds.
enum class Kind {
  kTime,
  kRobot,
  kEnd,  ///< a robot or an anchor
  kName,
  kNumber,
  kCoordinate,
  kDistance,
  kCoordinateOrEmpty,
  kSigma,
  kSigmaOrEmpty,  ///< may be 0
};

struct Column {
  std::string_view name;
  Kind kind;
};

void check_name(const CsvReader& csv, std::size_t column, const TeamNames& names, Kind kind) {
  const std::string_view name = csv.field(column);
  if (names.robots.contains(name) || (kind == Kind::kEnd && names.anchors.contains(name))) return;
  csv.fail("unknown robot '" + std::string(name) + "'");
}

void check_field(const CsvReader& csv, std::size_t column, Kind kind, const TeamNames& names) {
  const bool empty = csv.field(column).empty();
  switch (kind) {
    case Kind::kTime:
      csv.stamp(column);
      return;
    case Kind::kRobot:
    case Kind::kEnd:
      return check_name(csv, column, names, kind);
    case Kind::kName:
      if (empty) csv.fail("the id is empty");
      return;
    case Kind::kNumber:
      csv.number(column);
      return;
    case Kind::kCoordinateOrEmpty:
      if (empty) return;
      [[fallthrough]];
    case Kind::kCoordinate:
      csv.coordinate(column);
      return;
    case Kind::kDistance:
      if (csv.coordinate(column) < 0) csv.fail("a distance is negative");
      return;
    case Kind::kSigmaOrEmpty:
      if (!empty) csv.sigma(column);
      return;
    case Kind::kSigma:
      if (csv.sigma(column) <= 0) csv.fail("a sigma is zero");
      return;
  }
}

CsvReader::Columns names_of(const std::vector<Column>& columns) {
  CsvReader::Columns result;
  for (const Column& column : columns) result.required.push_back(column.name);
  return result;
}

/// Checks field by field, then each row as a whole.
void check_table(
    const Text& text, const std::vector<Column>& columns, const TeamNames& names,
    const std::function<void(const CsvReader&)>& check_row = [](const CsvReader&) {}) {
  CsvReader csv(text, names_of(columns));
  while (csv.next()) {
    for (std::size_t k = 0; k < columns.size(); ++k) check_field(csv, k, columns[k].kind, names);
    check_row(csv);
  }
}

/// Refuses a row whose ends, in these columns, are one robot or one anchor.
void refuse_itself(const CsvReader& csv, std::size_t end_i, std::size_t end_j, const std::string& what) {
  if (csv.field(end_i) == csv.field(end_j))
    csv.fail(what + " '" + std::string(csv.field(end_i)) + "' with itself");
}

void refuse_unless_unit_quaternion(const CsvReader& csv, std::size_t first) {
  const double norm = std::hypot(std::hypot(csv.number(first), csv.number(first + 1)),
                                 std::hypot(csv.number(first + 2), csv.number(first + 3)));
  if (!(std::abs(norm - 1) <= kUnitQuaternionTolerance)) csv.fail(not_a_unit_quaternion(norm));
}

}  // namespace

void check_ranges(const Text& text, const TeamNames& names) {
  check_table(text,
              {{"t_s", Kind::kTime},
               {"robot_i", Kind::kEnd},
               {"robot_j", Kind::kEnd},
               {"range_m", Kind::kDistance},
               {"sigma_m", Kind::kSigma}},
              names, [](const CsvReader& csv) { refuse_itself(csv, 1, 2, "a range of"); });
}

void check_angles(const Text& text, const TeamNames& names) {
  check_table(text,
              {{"t_s", Kind::kTime},
               {"receiver", Kind::kRobot},
               {"transmitter", Kind::kEnd},
               {"path", Kind::kNumber},
               {"azimuth_rad", Kind::kNumber},
               {"elevation_rad", Kind::kNumber},
               {"sigma_rad", Kind::kSigma},
               {"power_db", Kind::kNumber}},
              names, [](const CsvReader& csv) { refuse_itself(csv, 1, 2, "an angle of"); });
}

void check_matches(const Text& text, const TeamNames& names) {
  check_table(text,
              {{"robot_i", Kind::kRobot},
               {"t_i_s", Kind::kTime},
               {"robot_j", Kind::kRobot},
               {"t_j_s", Kind::kTime},
               {"x", Kind::kCoordinate},
               {"y", Kind::kCoordinate},
               {"z", Kind::kCoordinate},
               {"qx", Kind::kNumber},
               {"qy", Kind::kNumber},
               {"qz", Kind::kNumber},
               {"qw", Kind::kNumber},
               {"sigma_t_m", Kind::kSigma},
               {"sigma_r_rad", Kind::kSigma}},
              names, [](const CsvReader& csv) {
                if (csv.stamp(1) == csv.stamp(3)) refuse_itself(csv, 0, 2, "a match at one time of");
                refuse_unless_unit_quaternion(csv, 7);
              });
}

std::set<std::string, std::less<>> read_anchor_ids(const Text& text, const TeamNames& names) {
  const std::vector<Column> columns = {{"id", Kind::kName},
                                       {"x_m", Kind::kCoordinateOrEmpty},
                                       {"y_m", Kind::kCoordinateOrEmpty},
                                       {"z_m", Kind::kCoordinateOrEmpty},
                                       {"sigma_m", Kind::kSigmaOrEmpty}};
  check_table(text, columns, names);
  std::set<std::string, std::less<>> ids;
  CsvReader csv(text, names_of(columns));
  while (csv.next()) {
    const std::string id(csv.field(0));
    if (names.robots.contains(id)) csv.fail("the anchor '" + id + "' has the id of a robot");
    if (!ids.insert(id).second) csv.fail("the anchor '" + id + "' stands there twice");
  }
  return ids;
}

void check_inertial(const Text& text) {
  const std::vector<Column> columns = {{"t_s", Kind::kTime},        {"ax_mps2", Kind::kNumber},
                                       {"ay_mps2", Kind::kNumber},  {"az_mps2", Kind::kNumber},
                                       {"wx_radps", Kind::kNumber}, {"wy_radps", Kind::kNumber},
                                       {"wz_radps", Kind::kNumber}};
  check_table(text, columns, {});
  CsvReader csv(text, names_of(columns));
  std::optional<Stamp> last;
  while (csv.next()) {
    const Stamp stamp = csv.stamp(0);
    if (last && stamp <= *last) csv.fail("time does not run forward");
    last = stamp;
  }
}

void check_fixes(const Text& text) {
  check_table(text,
              {{"t_s", Kind::kTime},
               {"x_m", Kind::kCoordinate},
               {"y_m", Kind::kCoordinate},
               {"z_m", Kind::kCoordinate},
               {"sigma_m", Kind::kSigma}},
              {});
}

std::vector<std::string> check_team_tables(const std::filesystem::path& mission_folder, TeamNames names) {
  std::vector<std::string> found;
  const auto with = [&](const std::string& name, const auto& check) {
    const std::filesystem::path path = mission_folder / name;
    if (!std::filesystem::exists(path)) return;
    check(read_text(path));
    found.push_back(name);
  };
  for (const std::string& robot : names.robots) {
    const std::string folder = "robots/" + robot;
    with(folder + "/imu.csv", [](const Text& text) { check_inertial(text); });
    with(folder + "/gnss.csv", [](const Text& text) { check_fixes(text); });
  }
  with("radio/anchors.csv", [&](const Text& text) { names.anchors = read_anchor_ids(text, names); });
  with("radio/ranges.csv", [&](const Text& text) { check_ranges(text, names); });
  with("radio/aoa.csv", [&](const Text& text) { check_angles(text, names); });
  with("matches.csv", [&](const Text& text) { check_matches(text, names); });
  return found;
}

}  // namespace radioslam
