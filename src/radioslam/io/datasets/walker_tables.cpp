#include "radioslam/io/datasets/walker_tables.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <regex>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/named_columns.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr double kGravity_mps2 = 9.80665;
constexpr double kGravityTolerance = 0.3;   // of a mean over walking and a cheap sensor's scale
constexpr double kFastestWalker_radps = 6;  // RMS of the rates of a hand-held phone: about 1
constexpr double kLongestInterval_s = 0.4;  // between samples

/// Whether a table's file has this in its name.
bool names_file(const Text& table, const char* word) {
  return lower_case(std::filesystem::path(table.name).stem().string()).find(word) != std::string::npos;
}

using Axes = std::array<std::size_t, 3>;

/// The columns of x, y and z, whose names are `prefix`, the axis and perhaps a unit; nothing if one is
/// missing.
std::optional<Axes> find_axes(const NamedColumns& names, const std::string& prefix) {
  Axes axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const std::string letter(1, "xyz"[axis]);
    const auto column = names.find("(?:.*_)?" + prefix + "_?" + letter + "(?:_.*)?");
    if (!column) return std::nullopt;
    axes[axis] = *column;
  }
  return axes;
}

constexpr const char* kForceNames = "(?:a|f|gf|[a-z]*(?:acc|accel|acceleration|accelerometer|force))";
constexpr const char* kRateNames =
    "(?:w|g|omega|[a-z]*(?:gyr|gyro|gyroscope)(?:rotation)?(?:rate)?|(?:[a-z]*rotation|angular)_?"
    "(?:rate|velocity|vel|speed))";
/// The columns of a table.
struct ImuColumns {
  std::size_t time = 0;
  std::optional<Axes> force, rate;
  bool rate_in_degrees = false;

  /// Nothing if the table has no sensor.
  static std::optional<ImuColumns> find(const Text& table, const CsvReader& csv) {
    const NamedColumns names(csv);
    const auto time = names.find_time();
    ImuColumns columns{time.value_or(0), find_axes(names, kForceNames), find_axes(names, kRateNames)};
    const bool is_named = columns.force || columns.rate;
    if (!is_named && (names_file(table, "acc") || names_file(table, "gravity")))
      columns.force = find_axes(names, "");
    if (!is_named && names_file(table, "gyr")) columns.rate = find_axes(names, "");
    if (!time || (!columns.force && !columns.rate)) return std::nullopt;
    if (columns.rate)
      columns.rate_in_degrees = std::regex_search(names.name((*columns.rate)[0]), std::regex("deg|_dps"));
    return columns;
  }
};

/// A row: its time as it is written, and the readings of both sensors, if the table has them.
struct ImuRow {
  std::string time;
  double time_value = 0;
  Eigen::Vector3d force, rate;
};

Eigen::Vector3d vector_in(const CsvReader& csv, const std::optional<Axes>& axes) {
  if (!axes) return Eigen::Vector3d::Zero();
  return {csv.number((*axes)[0]), csv.number((*axes)[1]), csv.number((*axes)[2])};
}

/// Reads one table and adds its samples.
class ImuTable {
 public:
  ImuTable(const Text& table, std::vector<std::string>& warnings) : table_(table), warnings_(warnings) {}

  /// `gravity`: a table of its own, where the accelerometer's lacks it; or null.
  void add_to(PhoneMotion& motion, const Text* gravity) {
    const ImuColumns columns = read();
    if (gravity != nullptr && columns.force) add_gravity(*gravity);
    const std::string unit = unit_of_times();
    if (columns.force)
      append(motion.specific_force_mps2, unit, &ImuRow::force, force_scale(), "accelerometer");
    if (columns.rate)
      append(motion.angular_rate_radps, unit, &ImuRow::rate, rate_scale(columns.rate_in_degrees),
             "gyroscope");
    skipped_.conclude(table_.name, "row", rows_.size(), warnings_);
  }

 private:
  ImuColumns read() {
    CsvReader csv(table_);
    const auto columns = ImuColumns::find(table_, csv);
    if (!columns)
      csv.fail("has no column of time, or neither x y z of an accelerometer nor of a gyroscope",
               InputError::Kind::kColumnOrder);
    read_rows(csv, *columns);
    return *columns;
  }

  /// Adds to every row the force of the row of another table that is nearest in time.
  void add_gravity(const Text& table) {
    ImuTable gravity(table, warnings_);
    gravity.read();
    const auto later = [](const ImuRow& a, const ImuRow& b) { return a.time_value < b.time_value; };
    std::stable_sort(gravity.rows_.begin(), gravity.rows_.end(), later);
    for (ImuRow& row : rows_) {
      auto nearest = std::lower_bound(gravity.rows_.begin(), gravity.rows_.end(), row, later);
      const bool is_last = nearest == gravity.rows_.end();
      if (is_last || (nearest != gravity.rows_.begin() &&
                      row.time_value - std::prev(nearest)->time_value < nearest->time_value - row.time_value))
        --nearest;
      row.force += nearest->force;
    }
    gravity.skipped_.conclude(table.name, "row", gravity.rows_.size(), warnings_);
  }

  void read_rows(CsvReader& csv, const ImuColumns& columns) {
    bool is_row = true;
    while (is_row)
      skipped_.attempt([&] {
        is_row = csv.next();
        if (!is_row) return;
        rows_.push_back({std::string(csv.field(columns.time)), csv.number(columns.time),
                         vector_in(csv, columns.force), vector_in(csv, columns.rate)});
      });
    if (rows_.size() < 2) skipped_.throw_first();
    if (rows_.size() < 2) table_.fail(1, "has fewer than two samples", InputError::Kind::kTooLittle);
  }

  /// The exponent behind the times that makes them seconds.
  std::string unit_of_times() {
    struct Unit {
      double seconds;
      const char *exponent, *name;
    };
    constexpr std::array kUnits = std::to_array<Unit>({{1, "", "s"},
                                                       {kSecondsPerMillisecond, "e-3", "milliseconds"},
                                                       {kSecondsPerMicrosecond, "e-6", "microseconds"},
                                                       {kSecondsPerNanosecond, "e-9", "nanoseconds"}});
    std::vector<double> intervals;
    for (std::size_t k = 1; k < rows_.size(); ++k)
      if (const double interval = rows_[k].time_value - rows_[k - 1].time_value; interval > 0)
        intervals.push_back(interval);
    const double interval = intervals.empty() ? 0 : upper_median(std::move(intervals));
    for (const Unit& unit : kUnits) {
      if (interval <= 0 || interval * unit.seconds > kLongestInterval_s) continue;
      if (unit.seconds < 1) warnings_.push_back(table_.name + ": its times are read as " + unit.name);
      return unit.exponent;
    }
    table_.fail(0, "its times are not those of samples: the median interval is " + format_number(interval),
                InputError::Kind::kClock);
  }

  double force_scale() {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const ImuRow& row : rows_) mean += row.force / static_cast<double>(rows_.size());
    for (const double unit_mps2 : {1.0, kGravity_mps2, kGravity_mps2 * kSecondsPerMillisecond}) {
      if (std::abs(mean.norm() * unit_mps2 / kGravity_mps2 - 1) > kGravityTolerance) continue;
      if (unit_mps2 != 1)
        warnings_.push_back(table_.name + ": its accelerations are read as " +
                            (unit_mps2 > 1 ? "g" : "thousandths of g"));
      return unit_mps2;
    }
    table_.fail(
        0,
        "the mean of its accelerations is " + format_number(mean.norm()) +
            ", which is gravity in no unit: 9.8 m/s^2 or 1 g is needed, of a sensor that is not turned over; "
            "some apps have gravity in a table of its own, such as Gravity.csv",
        InputError::Kind::kUnit);
  }

  double rate_scale(bool is_in_degrees) {
    double square = 0;
    for (const ImuRow& row : rows_) square += row.rate.squaredNorm() / static_cast<double>(rows_.size());
    if (!is_in_degrees && std::sqrt(square) < kFastestWalker_radps) return 1;
    warnings_.push_back(table_.name + ": its rates are read as degrees per second");
    return kRadiansPerDegree;
  }

  void append(std::vector<VectorSample>& samples, const std::string& unit, Eigen::Vector3d ImuRow::*reading,
              double scale, const std::string& sensor) {
    if (!samples.empty()) table_.fail(1, "is a second table of the " + sensor, InputError::Kind::kDuplicate);
    for (const ImuRow& row : rows_) {
      const auto stamp = parse_stamp(row.time + unit);
      if (stamp) samples.push_back({*stamp, row.*reading * scale});
    }
    const auto refusal = [this](std::size_t) {
      return InputError(table_.name, 0, "time runs backwards by more than a second",
                        InputError::Kind::kClock);
    };
    sort_records(
        samples, [](const VectorSample& sample) { return sample.stamp; }, refusal, skipped_);
  }

  const Text& table_;
  std::vector<std::string>& warnings_;
  std::vector<ImuRow> rows_;
  SkippedRecords skipped_;
};

/// Turns all samples so that the mean force points along z.
void turn_upright(PhoneMotion& motion) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const VectorSample& sample : motion.specific_force_mps2) mean += sample.value;
  const auto R_level_device = Eigen::Quaterniond::FromTwoVectors(mean, Eigen::Vector3d::UnitZ());
  for (auto* samples : {&motion.specific_force_mps2, &motion.angular_rate_radps})
    for (VectorSample& sample : *samples) sample.value = R_level_device * sample.value;
}

/// A waypoint, and the pose there.
SE3 facing(const Eigen::Vector2d& position, double yaw) { return lift(SE2(position, yaw)); }

/// Poses from one waypoint to just before the next one.
void append_line(const TrajectoryRow& from, const TrajectoryRow& to, double yaw,
                 std::vector<StampedPose<SE3>>& poses) {
  const double duration_s = seconds_between(from.pose.stamp, to.pose.stamp);
  const Eigen::Vector2d begin = from.pose.pose.translation().head<2>(),
                        end = to.pose.pose.translation().head<2>();
  const auto steps = static_cast<std::int64_t>(std::ceil(duration_s));
  for (std::int64_t step = 0; step < steps; ++step) {
    const double share = static_cast<double>(step) / static_cast<double>(steps);
    poses.push_back({Stamp{from.pose.stamp.ns + Stamp::from_seconds(share * duration_s).ns},
                     facing(begin + share * (end - begin), yaw)});
  }
}

Trajectory<SE3> along(const Trajectory<SE3>& waypoints) {
  std::vector<StampedPose<SE3>> poses;
  std::vector<TrajectoryRow> rows;
  for (const auto& waypoint : waypoints) rows.push_back({waypoint, 0});
  std::vector<std::optional<double>> yaws(rows.size());
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const Eigen::Vector2d way =
        (rows[k + 1].pose.pose.translation() - rows[k].pose.pose.translation()).head<2>();
    if (!way.isZero(0)) yaws[k] = std::atan2(way.y(), way.x());
  }
  // Standing keeps the direction in which the walker came, or else that in which it goes.
  const auto first = std::find_if(yaws.begin(), yaws.end(), [](const auto& yaw) { return yaw.has_value(); });
  double yaw = first == yaws.end() ? 0 : **first;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    yaw = yaws[k].value_or(yaw);
    append_line(rows[k], rows[k + 1], yaw, poses);
  }
  poses.push_back({rows.back().pose.stamp, facing(rows.back().pose.pose.translation().head<2>(), yaw)});
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace

bool is_walker_table(const Text& table) {
  const Text readable = with_commas(table);
  try {
    return ImuColumns::find(table, CsvReader(readable)).has_value();
  } catch (const InputError&) {  // without a header
    return false;
  }
}

PhoneMotion read_walker_imu(const std::vector<Text>& tables, std::vector<std::string>& warnings) {
  PhoneMotion motion;
  std::optional<Text> gravity;
  for (const Text& table : tables)
    if (names_file(table, "gravity")) gravity = with_commas(table);
  for (const Text& table : tables) {
    if (names_file(table, "gravity")) continue;
    const Text readable = with_commas(table);
    ImuTable(readable, warnings).add_to(motion, gravity ? &*gravity : nullptr);
  }
  const bool has_force = !motion.specific_force_mps2.empty();
  if (!has_force || motion.angular_rate_radps.empty())
    tables.front().fail(1,
                        std::string("has no columns of ") + (has_force ? "a gyroscope" : "an accelerometer") +
                            ", and no other table does",
                        InputError::Kind::kTooLittle);
  turn_upright(motion);
  return motion;
}

Trajectory<SE3> read_waypoints(const Text& table, std::vector<std::string>& warnings) {
  const Text readable = with_commas(table);
  CsvReader csv(readable);
  const NamedColumns names(csv);
  const auto time = names.find_time(), x = names.find("x(?:_.*)?"), y = names.find("y(?:_.*)?");
  if (!time || !x || !y) csv.fail("needs the columns t_s, x and y", InputError::Kind::kColumnOrder);
  std::vector<TrajectoryRow> rows;
  SkippedRecords skipped;
  bool is_row = true;
  while (is_row)
    skipped.attempt([&] {
      is_row = csv.next();
      if (is_row)
        rows.push_back(
            {{csv.stamp(*time), facing({csv.coordinate(*x), csv.coordinate(*y)}, 0)}, csv.at().number()});
    });
  skipped.conclude(table.name, "row", rows.size(), warnings);
  const Trajectory<SE3> waypoints = trajectory_of_rows(readable, rows, warnings);
  if (waypoints.size() < 2) table.fail(0, "has fewer than two waypoints", InputError::Kind::kTooLittle);
  return along(waypoints);
}

}  // namespace radioslam
