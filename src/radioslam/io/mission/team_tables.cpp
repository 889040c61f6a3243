#include "radioslam/io/mission/team_tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

RobotIndex robot_at(const CsvReader& csv, std::size_t column, const TeamNames& names) {
  const auto found = names.robots.find(csv.field(column));
  if (found == names.robots.end())
    csv.fail("unknown robot '" + std::string(csv.field(column)) + "'", InputError::Kind::kSpelling);
  return found->second;
}

/// The end of a link: a robot or an anchor.
LinkEnd end_at(const CsvReader& csv, std::size_t column, const TeamNames& names) {
  LinkEnd end;
  const auto anchor = names.anchors.find(csv.field(column));
  if (anchor != names.anchors.end())
    end.anchor = anchor->second;
  else
    end.robot = robot_at(csv, column, names);
  return end;
}

void read_antenna(const CsvReader& csv, std::size_t column, const TeamNames& names, LinkEnd& end) {
  if (!csv.given(column)) return;
  end.antenna = csv.field(column);
  if (!end.robot.valid()) csv.fail("antenna '" + end.antenna + "' of an anchor: only robots have antennas");
  const Antennas none;
  const Antennas& antennas =
      end.robot.index() < names.antennas.size() ? names.antennas[end.robot.index()] : none;
  const auto found = antennas.find(end.antenna);
  if (found == antennas.end())
    csv.fail("unknown antenna '" + end.antenna + "': mission.yaml does not list it for this robot",
             InputError::Kind::kSpelling);
  end.lever_arm_m = found->second;
}

double distance_at(const CsvReader& csv, std::size_t column) {
  const double distance_m = csv.coordinate(column);
  if (distance_m < 0) csv.fail("a distance is negative");
  return distance_m;
}

double positive_sigma(const CsvReader& csv, std::size_t column) {
  const double sigma = csv.sigma(column);
  if (sigma <= 0) csv.fail("a sigma is zero");
  return sigma;
}

/// Refuses a row whose ends, in these columns, are the same robot or anchor.
void refuse_itself(const CsvReader& csv, std::size_t end_i, std::size_t end_j, const std::string& what) {
  if (csv.field(end_i) == csv.field(end_j))
    csv.fail(what + " '" + std::string(csv.field(end_i)) + "' to itself", InputError::Kind::kDuplicate);
}

template <class Measurement>
void sort_by_time(std::vector<Measurement>& measurements) {
  std::stable_sort(measurements.begin(), measurements.end(),
                   [](const Measurement& a, const Measurement& b) { return a.stamp < b.stamp; });
}

RangeMeasurement range_at(const CsvReader& csv, const TeamNames& names) {
  enum : std::size_t { kTime, kI, kJ, kRange, kSigma, kAntennaI, kAntennaJ };
  RangeMeasurement range;
  range.stamp = csv.stamp(kTime);
  range.i = end_at(csv, kI, names);
  range.j = end_at(csv, kJ, names);
  if (!range.i.robot.valid() && !range.j.robot.valid()) csv.fail("neither end is a robot");
  refuse_itself(csv, kI, kJ, "a range from");
  range.range_m = distance_at(csv, kRange);
  range.sigma_m = positive_sigma(csv, kSigma);
  read_antenna(csv, kAntennaI, names, range.i);
  read_antenna(csv, kAntennaJ, names, range.j);
  return range;
}

/// One row of aoa.csv: a path and the key of its measurement.
struct PathRow {
  Stamp stamp;
  RobotIndex receiver;
  LinkEnd transmitter;
  double number = 0;
  AoaPath path;
};

PathRow path_at(const CsvReader& csv, const TeamNames& names) {
  enum : std::size_t { kTime, kReceiver, kTransmitter, kPath, kAzimuth, kElevation, kSigma, kPower };
  PathRow row;
  row.stamp = csv.stamp(kTime);
  row.receiver = robot_at(csv, kReceiver, names);
  row.transmitter = end_at(csv, kTransmitter, names);
  refuse_itself(csv, kReceiver, kTransmitter, "an angle from");
  row.number = csv.number(kPath);
  row.path.azimuth_rad = wrap_angle(csv.number(kAzimuth));
  if (csv.given(kElevation)) row.path.elevation_rad = wrap_angle(csv.number(kElevation));
  row.path.sigma_rad = positive_sigma(csv, kSigma);
  if (csv.given(kPower)) row.path.power_db = csv.number(kPower);
  return row;
}

std::vector<PathRow> read_paths(const Text& text, const TeamNames& names) {
  CsvReader csv(text, {{"t_s", "receiver", "transmitter", "path", "azimuth_rad", "elevation_rad", "sigma_rad",
                        "power_db"}});
  std::vector<PathRow> rows;
  while (csv.next()) rows.push_back(path_at(csv, names));
  std::stable_sort(rows.begin(), rows.end(),
                   [](const PathRow& a, const PathRow& b) { return a.stamp < b.stamp; });
  return rows;
}

std::optional<double> coordinate_or_empty(const CsvReader& csv, std::size_t column) {
  if (csv.field(column).empty()) return std::nullopt;
  return csv.coordinate(column);
}

Anchor anchor_at(const CsvReader& csv, int dimension) {
  enum : std::size_t { kId, kX, kY, kZ, kSigma };
  Anchor anchor;
  anchor.id = csv.field(kId);
  if (anchor.id.empty()) csv.fail("the id is empty");
  const auto x = coordinate_or_empty(csv, kX);
  const auto y = coordinate_or_empty(csv, kY);
  const auto z = coordinate_or_empty(csv, kZ);
  if (x && y && (z || dimension == 2)) anchor.position_m = Eigen::Vector3d(*x, *y, z.value_or(0));
  if (!csv.field(kSigma).empty()) anchor.sigma_m = csv.sigma(kSigma);
  return anchor;
}

/// The upper triangle in 21 columns from `first` on.
SE3::Jacobian covariance_at(const CsvReader& csv, std::size_t first) {
  SE3::Jacobian covariance;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      covariance(row, column) = covariance(column, row) = csv.number(first++);
  const Cholesky<SE3::Jacobian> cholesky(covariance);
  if (!cholesky.succeeded() || !cholesky.inverse().allFinite())
    csv.fail("the covariance is not positive definite");
  return covariance;
}

enum class MatchNoise { kSigmas, kCovariance };

PoseMatch match_at(const CsvReader& csv, const TeamNames& names, MatchNoise noise) {
  enum : std::size_t { kI, kTimeI, kJ, kTimeJ, kX, kY, kZ, kRotation, kNoise = kRotation + 4 };
  PoseMatch match;
  match.robot_i = robot_at(csv, kI, names);
  match.stamp_i = csv.stamp(kTimeI);
  match.robot_j = robot_at(csv, kJ, names);
  match.stamp_j = csv.stamp(kTimeJ);
  if (match.stamp_i == match.stamp_j) refuse_itself(csv, kI, kJ, "a match at the same time from");
  const Eigen::Vector3d position(csv.coordinate(kX), csv.coordinate(kY), csv.coordinate(kZ));
  match.T_i_j = SE3(position, csv.quaternion(kRotation));
  match.covariance = noise == MatchNoise::kCovariance
                         ? covariance_at(csv, kNoise)
                         : isotropic_covariance(positive_sigma(csv, kNoise), positive_sigma(csv, kNoise + 1));
  return match;
}

const std::string& name_of(const Mission& mission, const LinkEnd& end) {
  return end.robot.valid() ? mission.robots[end.robot.index()].id : mission.anchors[end.anchor.index()].id;
}

bool any_antenna(const Mission& mission) {
  for (const RangeMeasurement& range : mission.ranges)
    if (!range.i.antenna.empty() || !range.j.antenna.empty()) return true;
  return false;
}

void append_antenna(std::string& out, const LinkEnd& end) {
  RADIOSLAM_CHECK(!end.antenna.empty() || end.lever_arm_m.isZero(0),
                  "an end with a lever arm names its antenna");
  (out += ',') += end.antenna;
}

/// Whether two sigmas make exactly this covariance.
bool is_isotropic(const SE3::Jacobian& covariance) {
  return isotropic_covariance(std::sqrt(covariance(0, 0)), std::sqrt(covariance(3, 3))) == covariance;
}

void append_sigmas(std::string& out, const SE3::Jacobian& covariance) {
  append_number(out += ',', std::sqrt(covariance(0, 0)));
  append_number(out += ',', std::sqrt(covariance(3, 3)));
}

void append_covariance(std::string& out, const SE3::Jacobian& covariance) {
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) append_number(out += ',', covariance(row, column));
}

}  // namespace

std::vector<Anchor> read_anchors(const Text& text, const TeamNames& names, int dimension) {
  CsvReader csv(text, {{"id", "x_m", "y_m", "z_m", "sigma_m"}});
  std::vector<Anchor> anchors;
  std::set<std::string> ids;
  while (csv.next()) {
    anchors.push_back(anchor_at(csv, dimension));
    const std::string& id = anchors.back().id;
    if (names.robots.contains(id)) csv.fail("the anchor '" + id + "' has the id of a robot");
    if (!ids.insert(id).second)
      csv.fail("the anchor '" + id + "' appears twice", InputError::Kind::kDuplicate);
  }
  return anchors;
}

std::vector<RangeMeasurement> read_ranges(const Text& text, const TeamNames& names) {
  CsvReader csv(text, {{"t_s", "robot_i", "robot_j", "range_m", "sigma_m"}, {"antenna_i", "antenna_j"}});
  std::vector<RangeMeasurement> ranges;
  while (csv.next()) ranges.push_back(range_at(csv, names));
  sort_by_time(ranges);
  return ranges;
}

std::vector<AoaMeasurement> read_aoa(const Text& text, const TeamNames& names) {
  std::vector<AoaMeasurement> aoa_measurements;
  std::vector<std::vector<std::pair<double, AoaPath>>> numbered;
  std::map<std::tuple<Stamp, RobotIndex, RobotIndex, AnchorIndex>, std::size_t> places;
  for (const PathRow& row : read_paths(text, names)) {
    const auto [place, is_new] = places.try_emplace(
        {row.stamp, row.receiver, row.transmitter.robot, row.transmitter.anchor}, aoa_measurements.size());
    if (is_new) {
      aoa_measurements.push_back({row.stamp, row.receiver, row.transmitter, {}});
      numbered.emplace_back();
    }
    numbered[place->second].emplace_back(row.number, row.path);
  }
  for (std::size_t k = 0; k < aoa_measurements.size(); ++k) {
    std::stable_sort(numbered[k].begin(), numbered[k].end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [number, path] : numbered[k]) aoa_measurements[k].paths.push_back(path);
  }
  return aoa_measurements;
}

std::optional<Finding> check_azimuth_unit(const Text& text) {
  CsvReader csv(text, {{"azimuth_rad"}});
  std::size_t rows = 0, beyond = 0;
  double largest_rad = 0;
  while (csv.next()) {
    const double azimuth_rad = std::abs(csv.number(0));
    ++rows;
    beyond += azimuth_rad > 2 * std::numbers::pi;
    largest_rad = std::max(largest_rad, azimuth_rad);
  }
  if (20 * beyond <= rows) return std::nullopt;
  return Finding{"unit",
                 Severity::kError,
                 "",
                 "radio/aoa.csv",
                 "azimuth_rad is up to " + format_number(largest_rad),
                 "radians",
                 "multiply by pi/180: the angles look like degrees"};
}

std::vector<PoseMatch> read_matches(const Text& text, const TeamNames& names) {
  const std::vector<std::string> covariance = match_covariance_columns();
  const CsvReader header(text);
  const bool full = std::any_of(header.names().begin(), header.names().end(),
                                [](std::string_view name) { return name.starts_with("cov_"); });
  CsvReader::Columns columns{{"robot_i", "t_i_s", "robot_j", "t_j_s", "x", "y", "z", "qx", "qy", "qz", "qw"}};
  if (full)
    columns.required.insert(columns.required.end(), covariance.begin(), covariance.end());
  else
    columns.required.insert(columns.required.end(), {"sigma_t_m", "sigma_r_rad"});
  CsvReader csv(text, columns);
  std::vector<PoseMatch> matches;
  while (csv.next())
    matches.push_back(match_at(csv, names, full ? MatchNoise::kCovariance : MatchNoise::kSigmas));
  return matches;
}

std::string format_anchors(const Mission& mission) {
  std::string out = "id,x_m,y_m,z_m,sigma_m\n";
  for (const Anchor& anchor : mission.anchors) {
    out += anchor.id;
    for (int axis = 0; axis < 3; ++axis) {
      out += ',';
      if (anchor.position_m) append_number(out, (*anchor.position_m)(axis));
    }
    append_number(out += ',', anchor.sigma_m);
    out += '\n';
  }
  return out;
}

std::string format_ranges(const Mission& mission) {
  const bool antennas = any_antenna(mission);
  std::string out = "t_s,robot_i,robot_j,range_m,sigma_m";
  out += antennas ? ",antenna_i,antenna_j\n" : "\n";
  for (const RangeMeasurement& range : mission.ranges) {
    ((out += format_stamp(range.stamp)) += ',') += name_of(mission, range.i);
    (out += ',') += name_of(mission, range.j);
    append_number(out += ',', range.range_m);
    append_number(out += ',', range.sigma_m);
    if (antennas) append_antenna(out, range.i);
    if (antennas) append_antenna(out, range.j);
    out += '\n';
  }
  return out;
}

void append_aoa_rows(std::string& out, Stamp stamp, const std::string& receiver,
                     const std::string& transmitter, const std::vector<AoaPath>& paths) {
  const std::string start = format_stamp(stamp) + ',' + receiver + ',' + transmitter + ',';
  for (std::size_t p = 0; p < paths.size(); ++p) {
    append_number((out += start + std::to_string(p)) += ',', paths[p].azimuth_rad);
    out += ',';
    if (paths[p].elevation_rad) append_number(out, *paths[p].elevation_rad);
    append_number(out += ',', paths[p].sigma_rad);
    append_number(out += ',', paths[p].power_db);
    out += '\n';
  }
}

std::string format_aoa(const Mission& mission) {
  std::string out(kAoaHeader);
  for (const AoaMeasurement& aoa : mission.aoa_measurements)
    append_aoa_rows(out, aoa.stamp, mission.robots[aoa.receiver.index()].id,
                    name_of(mission, aoa.transmitter), aoa.paths);
  return out;
}

std::string format_matches(const Mission& mission) {
  const bool isotropic = std::all_of(mission.matches.begin(), mission.matches.end(),
                                     [](const PoseMatch& match) { return is_isotropic(match.covariance); });
  std::string out(kMatchPoseColumns);
  if (isotropic) (out += ',') += kMatchSigmaColumns;
  if (!isotropic)
    for (const std::string& name : match_covariance_columns()) (out += ',') += name;
  out += '\n';
  for (const PoseMatch& match : mission.matches) {
    out += mission.robots[match.robot_i.index()].id + ',' + format_stamp(match.stamp_i) + ',';
    out += mission.robots[match.robot_j.index()].id + ',' + format_stamp(match.stamp_j);
    for (int axis = 0; axis < 3; ++axis) append_number(out += ',', match.T_i_j.translation()(axis));
    for (int k = 0; k < 4; ++k) append_number(out += ',', match.T_i_j.rotation().coeffs()(k));
    if (isotropic)
      append_sigmas(out, match.covariance);
    else
      append_covariance(out, match.covariance);
    out += '\n';
  }
  return out;
}

}  // namespace radioslam
