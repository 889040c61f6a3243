#include "radioslam/io/lidar/carmen.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kMinStep_ns = 1000;
constexpr double kMaxTime_s = 8e9;
constexpr std::uint64_t kMaxReadings = 100'000;
constexpr std::size_t kFieldsBehindTime = 2;  ///< host and logger_timestamp

/// Angles and range limit of a scan's readings.
struct CarmenFan {
  double begin_rad = 0, step_rad = 0;
  SE2 T_body_laser;
};

struct CarmenScan {
  std::size_t line = 0;
  Stamp stamp;
  SE2 T_log_body;
  CarmenFan fan;
  double limit_m = std::numeric_limits<double>::infinity();  ///< stated in the line
  std::vector<float> ranges_m;
  std::vector<float> remissions;  ///< of each range; empty if not stated
};

std::string_view first_word(std::string_view line) { return line.substr(0, line.find_first_of(" \t")); }

/// The kind of lines from which scans are taken.
std::string kind_of_scans(const Text& text) {
  std::map<std::string, std::size_t, std::less<>> counts{{"FLASER", 0}, {"ROBOTLASER1", 0}, {"RLASER", 0}};
  TextLines lines(text);
  while (lines.next_with_content())
    if (const auto kind = counts.find(first_word(lines.line())); kind != counts.end()) ++kind->second;
  for (const char* kind : {"FLASER", "ROBOTLASER1", "RLASER"})
    if (counts[kind] > 0) return kind;
  text.fail(0, "contains no scans: no line FLASER, ROBOTLASER1 or RLASER");
}

SE2 read_planar_pose(LineFields& fields) {
  const double x_m = fields.coordinate("x");
  const double y_m = fields.coordinate("y");
  return {{x_m, y_m}, fields.number("theta")};
}

std::vector<float> read_readings(LineFields& fields) {
  const std::uint64_t count = fields.id("the number of readings");
  if (count > kMaxReadings) fields.fail("the number of readings is implausibly large");
  std::vector<float> readings;
  for (std::uint64_t k = 0; k < count; ++k)
    readings.push_back(static_cast<float>(fields.number("a reading")));
  return readings;
}

/// The angles of a line that states only its number of readings.
CarmenFan nominal_fan(std::size_t readings, const SE2& T_body_laser, const CarmenParams& params) {
  const double view_rad = radians(params.field_of_view_deg);
  const std::size_t steps = std::max<std::size_t>(readings - readings % 2, 1);
  return {-view_rad / 2, view_rad / static_cast<double>(steps), T_body_laser};
}

/// Refuses times that are more than about a century away.
Stamp plausible_time(const LineFields& fields, Stamp stamp) {
  if (std::abs(stamp.seconds()) > kMaxTime_s) fields.fail("the ipc_timestamp is implausible");
  return stamp;
}

/// Reads FLASER or RLASER, after its first word.
CarmenScan read_plain_scan(const TextLines& lines, LineFields& fields, const SE2& T_body_laser,
                           const CarmenParams& params) {
  CarmenScan scan;
  scan.line = lines.number();
  scan.ranges_m = read_readings(fields);
  scan.fan = nominal_fan(scan.ranges_m.size(), T_body_laser, params);
  read_planar_pose(fields);  // the corrected pose, in corrected logs
  scan.T_log_body = read_planar_pose(fields);
  scan.stamp = plausible_time(fields, fields.stamp("the ipc_timestamp"));
  return scan;
}

/// The time, which precedes the last two fields.
Stamp read_time_before_end(const TextLines& lines, LineFields& fields) {
  std::vector<std::string_view> rest;
  while (!fields.empty()) rest.push_back(fields.next("a value"));
  if (rest.size() <= kFieldsBehindTime) fields.fail("the line ends before its ipc_timestamp");
  return plausible_time(fields,
                        stamp_in(lines, rest[rest.size() - 1 - kFieldsBehindTime], "the ipc_timestamp"));
}

/// Reads ROBOTLASER1, after its first word.
CarmenScan read_described_scan(const TextLines& lines, LineFields& fields) {
  CarmenScan scan;
  scan.line = lines.number();
  fields.number("the laser_type");
  scan.fan.begin_rad = fields.number("the start_angle");
  fields.number("the field_of_view");
  scan.fan.step_rad = fields.number("the angular_resolution");
  const double limit_m = fields.number("the maximum_range");
  if (limit_m > 0) scan.limit_m = limit_m;
  fields.number("the accuracy");
  fields.number("the remission_mode");
  scan.ranges_m = read_readings(fields);
  scan.remissions = read_readings(fields);
  if (scan.remissions.size() != scan.ranges_m.size()) scan.remissions.clear();
  const SE2 T_log_laser = read_planar_pose(fields);
  scan.T_log_body = read_planar_pose(fields);
  scan.fan.T_body_laser = scan.T_log_body.inverse() * T_log_laser;
  scan.stamp = read_time_before_end(lines, fields);
  return scan;
}

/// The scanner's pose for FLASER or RLASER, if this PARAM line states it; nothing for other parameters.
std::optional<SE2> read_offset(LineFields& fields, const std::string& kind) {
  const std::string_view name = fields.next("a parameter's name");
  const bool is_rear = kind == "RLASER";
  if (name != (is_rear ? "robot_rearlaser_offset" : "robot_frontlaser_offset")) return std::nullopt;
  return SE2({fields.coordinate("the offset"), 0}, is_rear ? std::numbers::pi : 0);
}

/// Lines that are refused are left out with a warning.
std::vector<CarmenScan> read_scans(const Text& text, const std::string& kind, const CarmenParams& params,
                                   std::vector<std::string>& warnings) {
  SE2 T_body_laser({0, 0}, kind == "RLASER" ? std::numbers::pi : 0);
  std::vector<CarmenScan> scans;
  SkippedRecords skipped;
  TextLines lines(text);
  while (lines.next_with_content())
    skipped.attempt([&] {
      LineFields fields(lines);
      const std::string_view word = fields.next("a message's name");
      if (word == "PARAM") {
        if (const auto offset = read_offset(fields, kind)) T_body_laser = *offset;
      } else if (word == kind) {
        scans.push_back(kind == "ROBOTLASER1" ? read_described_scan(lines, fields)
                                              : read_plain_scan(lines, fields, T_body_laser, params));
      }
    });
  skipped.conclude(text.name, "line", scans.size(), warnings);
  return scans;
}

/// Leaves out lines that are stamped further off their neighbours than put_in_order moves, if they are few.
void leave_out_strays(const Text& text, std::vector<CarmenScan>& scans, const CarmenParams& params,
                      std::vector<std::string>& warnings) {
  constexpr double kMostStrays = 0.1;  // of the lines; a log with more is refused
  std::vector<Stamp> stamps;
  for (const CarmenScan& scan : scans) stamps.push_back(scan.stamp);
  const std::vector<std::size_t> in_order = rows_in_time_order(stamps);
  std::vector<CarmenScan> kept;
  SkippedRecords strays;
  auto next = in_order.begin();
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const bool is_in_order = next != in_order.end() && *next == k;
    if (is_in_order) ++next;
    const bool is_late =
        next != in_order.end() && stamps[k].seconds() - stamps[*next].seconds() > params.max_delay_s;
    const bool is_early =
        next != in_order.begin() && stamps[*(next - 1)].seconds() - stamps[k].seconds() > params.max_delay_s;
    if (!is_in_order && (is_late || is_early))
      strays.add(
          InputError(text.name, scans[k].line, "its time " + format_stamp(stamps[k]) + " is not in order"));
    else
      kept.push_back(scans[k]);
  }
  if (strays.count() == 0 ||
      static_cast<double>(strays.count()) > kMostStrays * static_cast<double>(scans.size()))
    return;
  scans = std::move(kept);
  warnings.push_back(strays.warning(text.name, "line"));
}

/// Moves lines with late stamps to just before the following ones, and counts them.
std::size_t put_in_order(const Text& text, std::vector<CarmenScan>& scans, const CarmenParams& params) {
  std::size_t late = 0;
  for (std::size_t k = scans.size(); k-- > 1;) {
    const Stamp next = scans[k].stamp;
    Stamp& stamp = scans[k - 1].stamp;
    if (stamp < next) continue;
    if (stamp.seconds() - next.seconds() > params.max_delay_s)
      text.fail(scans[k - 1].line, "its time " + format_stamp(stamp) +
                                       " is later than that of a following line, " + format_stamp(next) +
                                       " (max_delay_s)");
    stamp.ns = next.ns - kMinStep_ns;
    ++late;
  }
  return late;
}

/// The range limit of lines that state none: the log's largest reading.
void set_limits(std::vector<CarmenScan>& scans, const CarmenParams& params) {
  float max_m = 0;
  for (const CarmenScan& scan : scans)
    for (const float range_m : scan.ranges_m) max_m = std::max(max_m, range_m);
  for (CarmenScan& scan : scans) {
    if (std::isinf(scan.limit_m)) scan.limit_m = static_cast<double>(max_m);
    scan.limit_m = std::min(scan.limit_m, params.no_return_m);
  }
}

LidarScan points_of_fan(const CarmenScan& scan) {
  LidarScan points;
  for (std::size_t k = 0; k < scan.ranges_m.size(); ++k) {
    const auto range_m = static_cast<double>(scan.ranges_m[k]);
    if (range_m <= 0 || range_m >= scan.limit_m) continue;
    const double angle_rad = scan.fan.begin_rad + static_cast<double>(k) * scan.fan.step_rad;
    const Eigen::Vector2d point_m =
        scan.fan.T_body_laser * Eigen::Vector2d(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad));
    points.points.emplace_back(static_cast<float>(point_m.x()), static_cast<float>(point_m.y()), 0.0F);
    if (!scan.remissions.empty()) points.intensities.push_back(scan.remissions[k]);
  }
  return points;
}

Trajectory<SE3> odometry_of(const std::vector<CarmenScan>& scans) {
  const SE2 T_start_log = scans.front().T_log_body.inverse();
  std::vector<StampedPose<SE3>> poses;
  for (const CarmenScan& scan : scans) poses.push_back({scan.stamp, lift(T_start_log * scan.T_log_body)});
  return Trajectory<SE3>(std::move(poses));
}

/// Width of the scans' field of view about the body's x axis; the full circle if they do not face forwards.
double view_of(const CarmenScan& scan) {
  const double view_rad = static_cast<double>(scan.ranges_m.size()) * std::abs(scan.fan.step_rad);
  const double middle_rad =
      scan.fan.begin_rad + scan.fan.step_rad * static_cast<double>(scan.ranges_m.size()) / 2;
  const bool looks_ahead = std::abs(wrap_angle(scan.fan.T_body_laser.angle() + middle_rad)) < view_rad / 2;
  return looks_ahead ? std::min(view_rad, 2 * std::numbers::pi) : 2 * std::numbers::pi;
}

LidarLog log_of(std::vector<CarmenScan> scans) {
  LidarLog log;
  for (const CarmenScan& scan : scans) log.stamps.push_back(scan.stamp);
  const auto kept = std::make_shared<const std::vector<CarmenScan>>(std::move(scans));
  log.read = [kept](std::size_t k) { return points_of_fan(kept->at(k)); };
  return log;
}

}  // namespace

ImportedMission read_carmen(const Text& text, const std::string& robot, const CarmenParams& params) {
  ImportedMission imported;
  std::vector<CarmenScan> scans = read_scans(text, kind_of_scans(text), params, imported.warnings);
  leave_out_strays(text, scans, params, imported.warnings);
  if (const std::size_t late = put_in_order(text, scans, params); late > 0)
    imported.warnings.push_back(std::to_string(late) +
                                " scans are stamped later than a following one and were moved to before it");
  set_limits(scans, params);
  Robot& recorded = imported.mission.robots.emplace_back();
  recorded.id = robot;
  recorded.odometry = odometry_of(scans);
  recorded.odometry_noise.sigma_xy_per_sqrt_m = params.sigma_xy_per_sqrt_m;
  recorded.odometry_noise.sigma_yaw_per_sqrt_m_rad = params.sigma_yaw_per_sqrt_m_rad;
  recorded.odometry_noise.sigma_yaw_per_rad = params.sigma_yaw_per_rad;
  recorded.lidar_view_rad = view_of(scans.front());
  recorded.lidar = log_of(std::move(scans));
  return imported;
}

}  // namespace radioslam
