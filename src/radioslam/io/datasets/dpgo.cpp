#include "radioslam/io/datasets/dpgo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/io/graph/keyed_poses.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxDpgoRobots = 52;  // letters
constexpr std::size_t kDpgoNumbers = 9;       // qx to tau

/// The ends and numbers of a row, by which two tables have the same measurement.
struct DpgoRow {
  std::uint64_t i = 0, j = 0;  // keys
  std::array<double, kDpgoNumbers> numbers{};
  bool operator<(const DpgoRow& other) const {
    return std::tie(i, j, numbers) < std::tie(other.i, other.j, other.numbers);
  }
};

std::uint64_t key_at(const CsvReader& csv, std::size_t robot_column) {
  const auto robot = parse_id(csv.field(robot_column)), pose = parse_id(csv.field(robot_column + 1));
  if (!robot || *robot >= kMaxDpgoRobots)
    csv.fail("'" + std::string(csv.field(robot_column)) + "' is not a robot");
  if (!pose || *pose > kKeyPlaceMask)
    csv.fail("'" + std::string(csv.field(robot_column + 1)) + "' is not a pose");
  const std::uint64_t letter =
      *robot < kMaxDpgoRobots / 2 ? 'a' + *robot : 'A' + (*robot - kMaxDpgoRobots / 2);
  return (letter << kKeyRobotShift) | *pose;
}

class DpgoReader {
 public:
  void add(const Text& table) {
    CsvReader csv(table, {{"robot_src", "pose_src", "robot_dst", "pose_dst", "qx", "qy", "qz", "qw", "tx",
                           "ty", "tz", "kappa", "tau"}});
    SkippedRecords skipped;
    std::set<DpgoRow> of_this_table;
    while (read_row(csv, skipped, of_this_table)) {
    }
    earlier_.merge(of_this_table);
    if (skipped.count() > 0) notes_.push_back(skipped.warning(table.name, "line"));
    if (graph_.relative_poses.empty()) skipped.throw_first();
  }

  TeamGraphFile<SE3> finish() {
    TeamGraphFile<SE3> out = poses_.assemble(std::move(graph_), StatedStarts::kIgnored).file;
    out.notes = std::move(notes_);
    return out;
  }

 private:
  /// False at the end of the table.
  bool read_row(CsvReader& csv, SkippedRecords& skipped, std::set<DpgoRow>& of_this_table) {
    try {
      if (!csv.next()) return false;
      const auto [row, factor] = factor_at(csv);
      if (!earlier_.contains(row)) add(row, factor);
      of_this_table.insert(row);
    } catch (const InputError& error) {
      skipped.add(error);
    }
    return true;
  }

  static std::pair<DpgoRow, RelativePoseFactor<SE3>> factor_at(const CsvReader& csv) {
    enum : std::size_t { kSource, kTarget = 2, kRotation = 4, kX = 8, kY, kZ, kKappa, kTau };
    DpgoRow row{key_at(csv, kSource), key_at(csv, kTarget), {}};
    if (row.i == row.j) csv.fail("a measurement from a pose to itself");
    for (std::size_t k = 0; k < kDpgoNumbers; ++k) row.numbers[k] = csv.number(kRotation + k);
    RelativePoseFactor<SE3> factor;
    factor.T_i_j =
        SE3({csv.coordinate(kX), csv.coordinate(kY), csv.coordinate(kZ)}, csv.quaternion(kRotation));
    const double kappa = csv.number(kKappa), tau = csv.number(kTau);
    if (kappa <= 0 || tau <= 0) csv.fail("a precision is not positive");
    SE3::Tangent information = SE3::Tangent::Constant(tau);
    information.tail<3>().setConstant(2 * kappa);
    factor.information = information.asDiagonal();
    return {row, factor};
  }

  void add(const DpgoRow& row, RelativePoseFactor<SE3> factor) {
    factor.i = poses_.at(row.i);
    factor.j = poses_.at(row.j);
    graph_.relative_poses.push_back(factor);
  }

  PoseGraph<SE3> graph_;
  KeyedPoses poses_;
  std::set<DpgoRow> earlier_;  // of earlier tables
  std::vector<std::string> notes_;
};

std::vector<fs::path> tables_in(const fs::path& source) {
  if (!fs::is_directory(source)) return {source};
  std::vector<fs::path> tables =
      files_in(source, Depth::kBelow, [](const fs::path& file) { return file.extension() == ".csv"; });
  if (tables.empty()) throw InputError(source.string(), 0, "the folder has no .csv files");
  return tables;
}

/// A random walk that has the variances of the robot's first step at its median step.
OdometryNoise noise_of(const TeamGraphFile<SE3>& file, const TrajectorySegment& segment) {
  OdometryNoise noise;
  std::vector<double> steps_m;
  const RelativePoseFactor<SE3>* first = nullptr;
  for (const auto& factor : file.team.graph.relative_poses) {
    const bool is_step = factor.i.index() >= segment.first_pose && factor.j.value == factor.i.value + 1 &&
                         factor.j.index() < segment.first_pose + segment.pose_count;
    if (!is_step) continue;
    if (first == nullptr) first = &factor;
    steps_m.push_back(factor.T_i_j.translation().norm());
  }
  if (first == nullptr) return noise;
  const double step_m = lower_median(std::move(steps_m));
  if (step_m <= 0) return noise;
  noise.sigma_xy_per_sqrt_m = noise.sigma_z_per_sqrt_m = 1 / std::sqrt(first->information(0, 0) * step_m);
  noise.sigma_yaw_per_sqrt_m_rad = 1 / std::sqrt(first->information(5, 5) * step_m);
  noise.sigma_yaw_per_rad = 0;
  return noise;
}

Robot robot_of(const TeamGraphFile<SE3>& file, const TrajectorySegment& segment) {
  Robot robot;
  robot.id = segment.robot;
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < segment.pose_count; ++k)
    rows.push_back({segment.stamps[k], file.team.graph.poses[segment.first_pose + k]});
  robot.odometry = Trajectory<SE3>(std::move(rows));
  robot.odometry_noise = noise_of(file, segment);
  return robot;
}

}  // namespace

TeamGraphFile<SE3> read_dpgo(std::span<const Text> tables) {
  DpgoReader reader;
  for (const Text& table : tables) reader.add(table);
  TeamGraphFile<SE3> file = reader.finish();
  if (file.pose_ids.empty()) tables.front().fail(0, "the table has no rows");
  return file;
}

TeamGraphFile<SE3> import_dpgo(const std::vector<fs::path>& sources) {
  std::vector<Text> tables;
  for (const fs::path& source : sources)
    for (const fs::path& table : tables_in(source)) tables.push_back(read_tool_output(table));
  return read_dpgo(tables);
}

ImportedMission mission_of_team(const TeamGraphFile<SE3>& file, const std::string& source) {
  ImportedMission imported;
  imported.mission.name = fs::path(source).filename().string();
  imported.mission.dimension = 3;
  imported.warnings = file.notes;
  std::vector<std::pair<RobotIndex, Stamp>> places;
  std::size_t first_loop = 0;
  for (const TrajectorySegment& segment : file.team.segments) {
    auto& robots = imported.mission.robots;
    if (!robots.empty() && robots.back().id == segment.robot)
      throw InputError(source, 0,
                       "the odometry of robot " + segment.robot +
                           " has a gap, and a mission has none: write a .g2o file instead; `run` places what "
                           "measurements tie to the rest");
    for (const Stamp stamp : segment.stamps) places.emplace_back(robots.size(), stamp);
    robots.push_back(robot_of(file, segment));
    first_loop += segment.pose_count - 1;
  }
  const auto& factors = file.team.graph.relative_poses;
  for (std::size_t f = first_loop; f < factors.size(); ++f) {
    const auto [robot_i, stamp_i] = places[factors[f].i.index()];
    const auto [robot_j, stamp_j] = places[factors[f].j.index()];
    imported.mission.matches.push_back(
        {robot_i, robot_j, stamp_i, stamp_j, factors[f].T_i_j, inverse(factors[f].information)});
  }
  return imported;
}

}  // namespace radioslam
