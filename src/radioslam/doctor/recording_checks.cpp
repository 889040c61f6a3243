#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kMaxInside = 0.05;  // of a file's times in another unit, within the motion
constexpr double kTolerance_s = 3;   // by which sensors begin and end at different times

struct Interval {
  double begin_s = 0, end_s = 0;
  double length_s() const { return end_s - begin_s; }
  /// Whether times from `first_s` to `last_s` are all outside.
  bool is_disjoint(double first_s, double last_s) const {
    return first_s > end_s + kTolerance_s || last_s < begin_s - kTolerance_s;
  }
  bool contains(double t_s) const { return begin_s - kTolerance_s <= t_s && t_s <= end_s + kTolerance_s; }
};

/// Stamps of one file of a robot.
struct Times {
  std::string file;
  std::vector<double> t_s;
  double max_gap_s;  ///< beyond which a gap is worth a word
};

template <class Rows>
std::vector<double> stamps_of(const Rows& rows) {
  std::vector<double> t_s;
  for (const auto& row : rows) t_s.push_back(row.stamp.seconds());
  return t_s;
}

std::optional<Interval> motion_interval(const Robot& robot) {
  if (robot.odometry.size() > 1)
    return Interval{robot.odometry.front().stamp.seconds(), robot.odometry.back().stamp.seconds()};
  if (robot.lidar.size() > 1)
    return Interval{robot.lidar.stamps.front().seconds(), robot.lidar.stamps.back().seconds()};
  return std::nullopt;
}

std::vector<Times> files_of(const Robot& robot) {
  std::vector<Times> files;
  const auto add = [&](const char* name, std::vector<double> t_s, double max_gap_s) {
    if (!t_s.empty()) files.push_back({robot_file(robot.id, name), std::move(t_s), max_gap_s});
  };
  add("wifi.csv", stamps_of(robot.wifi), 300);
  add("imu.csv", stamps_of(robot.inertial), 1);
  add("gnss.csv", stamps_of(robot.fixes), 900);
  std::vector<double> scans;
  if (!robot.odometry.empty())
    for (const Stamp stamp : robot.lidar.stamps) scans.push_back(stamp.seconds());
  add("lidar", std::move(scans), 3);
  return files;
}

/// The unit in which times, hardly any of which are within the motion, would cover it.
std::optional<const char*> unit_of_times(const std::vector<double>& t_s, const Interval& motion) {
  const auto inside = std::count_if(t_s.begin(), t_s.end(), [&](double t) { return motion.contains(t); });
  if (static_cast<double>(inside) > kMaxInside * static_cast<double>(t_s.size())) return std::nullopt;
  const auto [first, last] = std::minmax_element(t_s.begin(), t_s.end());
  for (const auto& [name, seconds] : kTimeUnits) {
    const double begin = *first * seconds, length = (*last - *first) * seconds;
    if (motion.contains(begin) && length > 0.3 * motion.length_s() && length < 1.2 * motion.length_s())
      return name;
  }
  return std::nullopt;
}

class FileTimes {
 public:
  FileTimes(const Robot& robot, const Interval& motion, const Times& file, std::vector<Finding>& findings)
      : robot_(robot), motion_(motion), file_(file), findings_(findings) {}

  void run() {
    if (file_.t_s.size() < 5) return;
    if (const auto unit = unit_of_times(file_.t_s, motion_))
      return add("unit", Severity::kError, times_text() + ", which look like " + *unit, "seconds",
                 "convert the times to seconds");
    if (motion_.is_disjoint(file_.t_s.front(), file_.t_s.back())) return report_other_clock();
    if (!report_offset()) report_gap();
  }

 private:
  void add(const char* kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back(
        {kind, severity, robot_.id, file_.file, std::move(found), std::move(expected), std::move(advice)});
  }

  std::string times_text() const {
    return "times from " + number(file_.t_s.front()) + " to " + number(file_.t_s.back());
  }
  std::string motion_text() const { return number(motion_.begin_s) + " to " + number(motion_.end_s) + " s"; }

  void report_other_clock() {
    add("clock", Severity::kError, times_text(), "the clock of the robot's odometry, " + motion_text(),
        "subtract about " + number(file_.t_s.front() - motion_.begin_s) + " s");
  }

  /// Begins and ends both by the same time before or after the odometry.
  bool report_offset() {
    const double begin = file_.t_s.front() - motion_.begin_s, end = file_.t_s.back() - motion_.end_s;
    const double spacing = (file_.t_s.back() - file_.t_s.front()) / static_cast<double>(file_.t_s.size() - 1);
    const double tolerance = std::max(1.0, 1.5 * spacing);
    if (std::abs(begin - end) > tolerance || std::abs(begin) < 2 * tolerance || std::abs(begin) < 2.5)
      return false;
    add("clock", Severity::kWarning,
        "begins and ends " + number(std::abs(begin)) + " s " + (begin > 0 ? "after" : "before") +
            " the odometry",
        "the clock of the odometry", "subtract " + number(0.5 * (begin + end)) + " s if the clocks differ");
    return true;
  }

  void report_gap() {
    std::vector<double> steps;
    for (std::size_t k = 1; k < file_.t_s.size(); ++k) steps.push_back(file_.t_s[k] - file_.t_s[k - 1]);
    const double usual = median(steps), limit = std::max(file_.max_gap_s, 20 * usual);
    const double missing_s = motion_.end_s - file_.t_s.back();
    if (missing_s > limit && missing_s > 0.5 * motion_.length_s())
      return add("gap", Severity::kWarning, "ends " + number(missing_s) + " s before the odometry",
                 "a row every " + number(usual) + " s to the end", "check whether the recording was cut");
    const auto longest = std::max_element(steps.begin(), steps.end());
    if (*longest > limit)
      add("gap", Severity::kWarning,
          "no row for " + number(*longest) + " s after " +
              number(file_.t_s[static_cast<std::size_t>(longest - steps.begin())]) + " s",
          "a row every " + number(usual) + " s", "check whether the recording was interrupted");
  }

  const Robot& robot_;
  Interval motion_;
  const Times& file_;
  std::vector<Finding>& findings_;
};

/// Times at which one of the team's files refers to each robot.
using TimesOfRobots = std::vector<std::vector<double>>;

void check_team_file(const Mission& mission, const std::string& file, const TimesOfRobots& times,
                     std::vector<Finding>& findings) {
  std::vector<std::size_t> outside;
  std::size_t referred = 0;
  std::optional<const char*> unit;
  for (std::size_t r = 0; r < times.size(); ++r) {
    const auto motion = motion_interval(mission.robots[r]);
    if (times[r].size() < 10 || !motion) continue;
    ++referred;
    if (!unit) unit = unit_of_times(times[r], *motion);
    const auto [first, last] = std::minmax_element(times[r].begin(), times[r].end());
    if (motion->is_disjoint(*first, *last)) outside.push_back(r);
  }
  const auto add = [&](std::string robot, std::string in, double begin_s, std::string expected) {
    findings.push_back({"clock", Severity::kError, std::move(robot), std::move(in),
                        "times from " + number(begin_s) + " s", std::move(expected),
                        "use one clock for all files, in seconds"});
  };
  if (unit)
    return findings.push_back({"unit", Severity::kError, "", file, std::string("times look like ") + *unit,
                               "seconds", "convert the times to seconds"});
  if (outside.empty()) return;
  if (outside.size() == referred) {
    const std::size_t r = outside.front();
    return add(
        "", file, *std::min_element(times[r].begin(), times[r].end()),
        "the clock of the odometry, from " + number(motion_interval(mission.robots[r])->begin_s) + " s");
  }
  for (const std::size_t r : outside)
    add(mission.robots[r].id,
        mission.robots[r].odometry.empty() ? robot_file(mission.robots[r].id, "lidar")
                                           : odometry_file(mission.robots[r].id),
        motion_interval(mission.robots[r])->begin_s,
        "the clock of " + file + ", from " + number(*std::min_element(times[r].begin(), times[r].end())) +
            " s");
}

void check_team_files(const Mission& mission, std::vector<Finding>& findings) {
  const TimesOfRobots none(mission.robots.size());
  TimesOfRobots ranges = none, angles = none, matches = none;
  const auto refer = [](TimesOfRobots& times, RobotIndex robot, Stamp stamp) {
    if (robot.valid()) times[robot.index()].push_back(stamp.seconds());
  };
  for (const auto& range : mission.ranges) {
    refer(ranges, range.i.robot, range.stamp);
    refer(ranges, range.j.robot, range.stamp);
  }
  for (const auto& angle : mission.aoa_measurements) {
    refer(angles, angle.receiver, angle.stamp);
    refer(angles, angle.transmitter.robot, angle.stamp);
  }
  for (const auto& match : mission.matches) {
    refer(matches, match.robot_i, match.stamp_i);
    refer(matches, match.robot_j, match.stamp_j);
  }
  check_team_file(mission, kRangesFile, ranges, findings);
  check_team_file(mission, kAnglesFile, angles, findings);
  check_team_file(mission, "matches.csv", matches, findings);
}

/// Sets that grow together.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t of(std::size_t x) const {
    while (parent_[x] != x) x = parent_[x];
    return x;
  }
  void join(std::size_t x, std::size_t y) { parent_[of(x)] = of(y); }

 private:
  std::vector<std::size_t> parent_;
};

/// Joins robots that heard the same access points.
void join_by_fingerprints(const Mission& mission, Components& components) {
  std::map<std::size_t, std::size_t> first_robot;
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    for (const WifiScan& scan : mission.robots[r].wifi)
      for (const WifiReading& reading : scan.readings) {
        const auto [entry, is_new] = first_robot.try_emplace(reading.access_point.index(), r);
        if (!is_new) components.join(r, entry->second);
      }
}

void join_by_links(const Mission& mission, std::size_t world, Components& components) {
  const auto node = [&](const LinkEnd& end) {
    return end.robot.valid() ? end.robot.index() : world + 1 + end.anchor.index();
  };
  for (std::size_t k = 0; k < mission.anchors.size(); ++k)
    if (mission.anchors[k].position_m) components.join(world + 1 + k, world);
  for (const auto& range : mission.ranges) components.join(node(range.i), node(range.j));
  for (const auto& angle : mission.aoa_measurements)
    components.join(angle.receiver.index(), node(angle.transmitter));
  for (const auto& match : mission.matches) components.join(match.robot_i.index(), match.robot_j.index());
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    if (robot.initial_pose || !robot.fixes.empty()) components.join(r, world);
  }
}

/// Ranges that no radio between robots measures.
bool check_distances(const Mission& mission, std::vector<Finding>& findings) {
  constexpr double kFarthest_m = 20e3;
  std::vector<double> ranges_m;
  for (const RangeMeasurement& range : mission.ranges) ranges_m.push_back(range.range_m);
  if (ranges_m.empty()) return false;
  const double usual_m = upper_median(std::move(ranges_m));
  if (usual_m <= kFarthest_m) return false;
  findings.push_back({"unit", Severity::kError, "", kRangesFile,
                      "the median distance is " + number(usual_m) + " m", "metres",
                      "multiply range_m and sigma_m by 0.001 if they are in millimetres"});
  return true;
}

/// How much a range changed, and the path of both its ends meanwhile.
struct RangeChange {
  double change_m, path_m, sigma_m;

  /// Whether ends that travel so far can change a range of another unit so much.
  bool is_possible(double metres_per_unit) const {
    constexpr double kSigmas = 3, kSlack_m = 0.5;
    return metres_per_unit * change_m <=
           path_m + kSlack_m + kSigmas * std::min(1.0, metres_per_unit) * sigma_m;
  }
};

/// Of successive ranges between the same antennas, over five metres or more of path.
std::vector<RangeChange> range_changes(const Mission& mission) {
  constexpr double kMinPath_m = 5;
  std::vector<Track> tracks;
  for (const Robot& robot : mission.robots) tracks.emplace_back(robot);
  const auto path_at = [&](const LinkEnd& end, double t_s) -> std::optional<double> {
    if (!end.robot.valid()) return 0;
    const auto row = tracks[end.robot.index()].at(t_s);
    return row ? std::optional(row->path_m) : std::nullopt;
  };
  const auto node = [&](const LinkEnd& end) {
    return end.robot.valid() ? end.robot.index() : tracks.size() + end.anchor.index();
  };
  using Ends = std::tuple<std::size_t, std::string, std::size_t, std::string>;
  std::map<Ends, std::pair<double, double>> last;  // path and range
  std::vector<RangeChange> changes;
  for (const RangeMeasurement& range : mission.ranges) {
    const auto path_i = path_at(range.i, range.stamp.seconds()),
               path_j = path_at(range.j, range.stamp.seconds());
    if (!path_i || !path_j) continue;
    const double path_m = *path_i + *path_j;
    const Ends ends{node(range.i), range.i.antenna, node(range.j), range.j.antenna};
    const auto [entry, is_new] = last.try_emplace(ends, path_m, range.range_m);
    if (is_new || path_m - entry->second.first < kMinPath_m) continue;
    changes.push_back(
        {std::abs(range.range_m - entry->second.second), path_m - entry->second.first, range.sigma_m});
    entry->second = {path_m, range.range_m};
  }
  return changes;
}

/// Ranges that change faster than their ends travel, and that do not in another unit.
void check_range_changes(const Mission& mission, std::vector<Finding>& findings) {
  constexpr std::size_t kMinChanges = 3;
  constexpr double kMinRatio = 8, kMinPossible = 0.9, kMaxPossible = 0.5;
  const std::vector<RangeChange> changes = range_changes(mission);
  if (changes.size() < kMinChanges) return;
  const auto possible = [&](double metres_per_unit) {
    const auto count = std::count_if(changes.begin(), changes.end(), [&](const RangeChange& change) {
      return change.is_possible(metres_per_unit);
    });
    return static_cast<double>(count) / static_cast<double>(changes.size());
  };
  std::vector<double> ratios;
  for (const RangeChange& change : changes) ratios.push_back(change.change_m / change.path_m);
  const double ratio = upper_median(std::move(ratios));
  if (ratio < kMinRatio || possible(1) > kMaxPossible) return;
  for (const auto& [unit, metres] : {std::pair{"centimetres", 0.01}, {"millimetres", 0.001}})
    if (possible(metres) >= kMinPossible)
      return findings.push_back(
          {"unit", Severity::kError, "", kRangesFile,
           "distances change by " + number(ratio) +
               " m for every metre that the robots travel, and fit their odometry if they are in " + unit,
           "metres", "multiply range_m and sigma_m by " + number(metres)});
}

}  // namespace

std::vector<Finding> check_times(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots) {
    const auto motion = motion_interval(robot);
    if (!motion) continue;
    for (const Times& file : files_of(robot)) FileTimes(robot, *motion, file, findings).run();
  }
  check_team_files(mission, findings);
  if (!check_distances(mission, findings)) check_range_changes(mission, findings);
  return findings;
}

std::vector<Finding> check_connections(const Mission& mission) {
  const std::size_t world = mission.robots.size();
  Components components(world + 1 + mission.anchors.size());
  join_by_links(mission, world, components);
  join_by_fingerprints(mission, components);
  const auto has_csi = [](const Robot& robot) { return robot.csi.has_value(); };
  if (mission.robots.size() < 2 || std::any_of(mission.robots.begin(), mission.robots.end(), has_csi))
    return {};
  std::map<std::size_t, std::size_t> sizes;
  for (std::size_t r = 0; r < world; ++r) ++sizes[components.of(r)];
  const auto largest = std::max_element(sizes.begin(), sizes.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<Finding> findings;
  for (std::size_t r = 0; r < world; ++r) {
    const std::size_t own = components.of(r);
    if (sizes.size() == 1 || (own == largest->first && largest->second > 1)) continue;
    findings.push_back({"not-connected", Severity::kWarning, mission.robots[r].id, "",
                        "no range, angle, match, fix or common access point ties robot '" +
                            mission.robots[r].id + "' to the rest of the team",
                        "at least one kind of link", "its trajectory stays in a frame of its own"});
  }
  return findings;
}

}  // namespace radioslam
