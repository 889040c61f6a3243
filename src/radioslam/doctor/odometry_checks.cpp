#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/quantile.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {
namespace {

// Whether a trajectory is in the frame that a mission asks for: right-handed, z up, quaternions with qw last,
// from the robot's start.

constexpr double kPlanarTilt_rad = 0.5;

class FrameCheck {
 public:
  FrameCheck(const Mission& mission, const Robot& robot, std::vector<Finding>& findings)
      : robot_(robot), is_planar_(mission.dimension == 2), findings_(findings) {}

  void run() {
    if (check_quaternions()) return;
    check_axes();
    check_heading();
    check_start();
  }

 private:
  void add(std::string kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back({std::move(kind), severity, robot_.id, odometry_file(robot_.id), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  static double tilt(const Eigen::Quaterniond& start, const Eigen::Quaterniond& q) {
    const Eigen::Vector3d up = start.inverse() * (q * Eigen::Vector3d::UnitZ());
    return std::atan2(up.head<2>().norm(), up.z());
  }

  double tilted_ratio(auto quaternion) const {
    const Eigen::Quaterniond start = quaternion(robot_.odometry.front().pose.rotation());
    double tilted = 0;
    for (const auto& row : robot_.odometry)
      tilted += tilt(start, quaternion(row.pose.rotation())) > kPlanarTilt_rad;
    return tilted / static_cast<double>(robot_.odometry.size());
  }

  /// Whether the quaternions are wrong.
  bool check_quaternions() {
    const double stated = tilted_ratio([](const auto& q) { return q; });
    const double w_first =
        tilted_ratio([](const auto& q) { return Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()); });
    if (stated < 0.2) return false;
    if (w_first < 0.02) {
      add("column-order", Severity::kError,
          "the robot is upside down or on its side in " + number(100 * stated) +
              " % of the poses, and level with qw first",
          "qx qy qz qw", "move the column qw behind qz");
      return true;
    }
    if (is_planar_)
      add("frame", Severity::kWarning, "the robot is tilted in " + number(100 * stated) + " % of the poses",
          "a level robot in a planar mission", "use dimension 3, or a body frame with z up");
    return false;
  }

  Eigen::Vector3d extent_m() const {
    Eigen::Vector3d low = robot_.odometry.front().pose.translation(), high = low;
    for (const auto& row : robot_.odometry) {
      low = low.cwiseMin(row.pose.translation());
      high = high.cwiseMax(row.pose.translation());
    }
    return high - low;
  }

  /// Vertical motion where the vehicle moves on the ground.
  void check_axes() {
    const Eigen::Vector3d extent = extent_m();
    const double flattest = std::min(extent.x(), extent.y());
    if (extent.z() < 5 || flattest > 0.05 * extent.z()) return;
    if (extent.z() < 0.5 * std::max(extent.x(), extent.y())) return;  // a straight road with a slope
    add("column-order", is_planar_ ? Severity::kError : Severity::kWarning,
        "the robot moves " + number(extent.z()) + " m along z and " + number(flattest) + " m along " +
            (extent.x() < extent.y() ? "x" : "y"),
        "z up", "exchange the columns, or turn the frame: cameras have z forward and y down");
  }

  /// Resultant length of the direction of motion in the body frame, |mean exp(i (direction -+ yaw))|.
  void check_heading() {
    std::complex<double> straight, mirrored, yaws;
    double count = 0;
    std::size_t from = 0;
    for (std::size_t k = 1; k < robot_.odometry.size(); ++k) {
      const Eigen::Vector3d step =
          robot_.odometry[k].pose.translation() - robot_.odometry[from].pose.translation();
      if (step.head<2>().norm() < 0.5) continue;
      const double turn = wrap_angle(robot_.odometry[k].pose.yaw() - robot_.odometry[from].pose.yaw());
      const double yaw = robot_.odometry[from].pose.yaw() + 0.5 * turn;
      const double direction = std::atan2(step.y(), step.x());
      from = k;
      if (std::abs(turn) > 0.8) continue;
      straight += std::polar(1.0, direction - yaw);
      mirrored += std::polar(1.0, direction + yaw);
      yaws += std::polar(1.0, 2 * yaw);
      count += 1;
    }
    if (count < 20 || std::abs(yaws) > 0.9 * count) return;  // a straight path looks the same in a mirror
    if (std::abs(mirrored) < 0.85 * count || std::abs(straight) > 0.6 * count) return;
    // Vehicles that reverse may look so, too.
    add("handedness", Severity::kWarning, "the path turns to one side while the yaw turns to the other",
        "a right-handed frame, y to the left of x and yaw counter-clockwise",
        "change the sign of y, exchange x and y, or change the sign of the yaw");
  }

  void check_start() {
    const SE3& first = robot_.odometry.front().pose;
    const double away_m = first.translation().norm();
    if (away_m < 1 && std::abs(first.yaw()) < 0.1) return;
    if (!robot_.initial_pose && away_m < 1e5) return;
    add("frame", Severity::kWarning,
        "the trajectory begins at " + number(away_m) + " m and " + number(degrees(first.yaw())) +
            " degrees from its frame's origin" +
            (robot_.initial_pose ? ", and mission.yaml states where it starts" : ""),
        "the robot's own start frame", "express the trajectory in the frame of its first pose");
  }

  const Robot& robot_;
  bool is_planar_;
  std::vector<Finding>& findings_;
};

/// Adds findings about a robot with odometry.
void check_frame(const Mission& mission, const Robot& robot, std::vector<Finding>& findings) {
  FrameCheck(mission, robot, findings).run();
}

constexpr double kMaxSpeed_mps = 60;  // of anything that drives
constexpr double kMinJump_m = 3;
constexpr double kMinGap_s = 3;

struct Step {
  double dt_s, length_m;
  std::size_t to;
};

std::vector<Step> steps_of(const Trajectory<SE3>& odometry) {
  std::vector<Step> steps;
  for (std::size_t k = 1; k < odometry.size(); ++k)
    steps.push_back({seconds_between(odometry[k - 1].stamp, odometry[k].stamp),
                     (odometry[k].pose.translation() - odometry[k - 1].pose.translation()).norm(), k});
  return steps;
}

std::vector<double> collected(const std::vector<Step>& steps, auto value) {
  std::vector<double> values;
  for (const Step& step : steps) values.push_back(value(step));
  return values;
}

double path_m(const std::vector<Step>& steps) {
  double sum = 0;
  for (const Step& step : steps) sum += step.length_m;
  return sum;
}

class RobotCheck {
 public:
  RobotCheck(const Mission& mission, const Robot& robot, std::vector<Finding>& findings)
      : mission_(mission), robot_(robot), findings_(findings), steps_(steps_of(robot.odometry)) {}

  void run() {
    check_amount();
    if (steps_.size() < 10) return;
    if (check_units()) return;
    check_jumps();
    check_gaps();
    check_frame(mission_, robot_, findings_);
  }

 private:
  void add(std::string kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back({std::move(kind), severity, robot_.id, odometry_file(robot_.id), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  double time_of(std::size_t k) const { return robot_.odometry[k].stamp.seconds(); }

  void check_amount() {
    const double duration_s = seconds_between(robot_.odometry.front().stamp, robot_.odometry.back().stamp);
    if (robot_.odometry.size() >= 5 && duration_s >= 5) return;
    add("too-little", Severity::kWarning,
        std::to_string(robot_.odometry.size()) + " poses within " + number(duration_s) + " s",
        "a recording of at least some minutes", "record it again, or leave the robot out");
  }

  /// Mean speeds over stretches of at least a second in which the robot moves.
  std::vector<double> speeds_over_a_second() const {
    std::vector<double> speeds;
    double dt_s = 0, length_m = 0;
    for (const Step& step : steps_) {
      dt_s += step.dt_s;
      length_m += step.length_m;
      if (dt_s < 1) continue;
      if (length_m > 0) speeds.push_back(length_m / dt_s);
      dt_s = length_m = 0;
    }
    return speeds;
  }

  /// Units of time and position; returns whether one is wrong.
  bool check_units() {
    const std::vector<double> speeds = speeds_over_a_second();
    if (speeds.size() < 5) return false;
    const double typical = median(speeds), fast = quantile(speeds, 0.95);
    const double dt_s = median(collected(steps_, [](const Step& s) { return s.dt_s; }));
    if (typical > kMaxSpeed_mps) {
      const char* unit = typical > 4 * kMaxSpeed_mps ? "millimetres" : "centimetres";
      add("unit", Severity::kError, "the robot moves at " + number(typical) + " m/s", "metres and seconds",
          std::string("positions look like ") + unit + ", or times like another unit");
    } else if (fast < 0.02 && dt_s >= 8 && path_m(steps_) > 5) {
      add("unit", Severity::kError,
          "the robot moves at " + number(typical) + " m/s, with a pose every " + number(dt_s) + " s",
          "seconds",
          dt_s > 1e5 ? "times look like nanoseconds or microseconds" : "times look like milliseconds");
    } else {
      return false;
    }
    return true;
  }

  /// Steps that are out of proportion to the others of the robot.
  void check_jumps() {
    const double usual_m = quantile(collected(steps_, [](const Step& s) { return s.length_m; }), 0.95);
    const double speed = quantile(collected(steps_, [](const Step& s) { return s.length_m / s.dt_s; }), 0.95);
    std::size_t jumps = 0;
    const Step* largest = nullptr;
    for (const Step& step : steps_) {
      const double limit = std::max(8 * speed, 5.0);
      if (step.length_m < kMinJump_m || step.length_m < 4 * usual_m || step.length_m / step.dt_s < limit)
        continue;
      ++jumps;
      if (!largest || step.length_m > largest->length_m) largest = &step;
    }
    if (!largest) return;
    add("speed", Severity::kWarning,
        std::to_string(jumps) + (jumps == 1 ? " jump, " : " jumps, the largest ") +
            number(largest->length_m) + " m within " + number(largest->dt_s) + " s at " +
            number(time_of(largest->to)) + " s",
        "continuous dead reckoning, at most about " + number(speed) + " m/s here",
        "use odometry without corrections by loop closures, and cut the recording where it was reset");
  }

  void check_gaps() {
    const double dt_s = median(collected(steps_, [](const Step& s) { return s.dt_s; }));
    const double usual_m = quantile(collected(steps_, [](const Step& s) { return s.length_m; }), 0.95);
    const Step* longest = nullptr;
    for (const Step& step : steps_)
      if (step.dt_s > std::max(kMinGap_s, 15 * dt_s) && step.length_m > std::max(1.0, 2 * usual_m) &&
          (!longest || step.dt_s > longest->dt_s))
        longest = &step;
    if (longest)
      add("gap", Severity::kWarning,
          "no pose for " + number(longest->dt_s) + " s before " + number(time_of(longest->to)) +
              " s, while the robot moved " + number(longest->length_m) + " m",
          "a pose every " + number(dt_s) + " s",
          "the motion within the gap is a guess: cut the recording there");
  }

  const Mission& mission_;
  const Robot& robot_;
  std::vector<Finding>& findings_;
  std::vector<Step> steps_;
};

/// Whether the steps of two trajectories are the same, wherever and whenever they begin.
bool same_recording(const Trajectory<SE3>& a, const Trajectory<SE3>& b) {
  if (a.size() < 21 || b.size() != a.size()) return false;
  const auto steps_a = steps_of(a), steps_b = steps_of(b);
  std::size_t moving = 0;
  for (std::size_t k = 0; k < steps_a.size(); ++k) {
    if (std::abs(steps_a[k].length_m - steps_b[k].length_m) > 1e-4) return false;
    moving += steps_a[k].length_m > 1e-3;
  }
  // Regular steps of one length are alike without being the same.
  const auto lengths = collected(steps_a, [](const Step& s) { return s.length_m; });
  const auto [low, high] = std::minmax_element(lengths.begin(), lengths.end());
  return moving > 10 && *high - *low > 1e-3;
}

constexpr double kMinMissing_s = 20, kMinMissingRatio = 0.25;
constexpr double kMaxLengths = 100;  // of the odometry: beyond, times are in another unit
constexpr std::size_t kMinRows = 10;

/// First and last row of one recording that a robot takes part in.
struct Recording {
  std::string file;
  double first_s = 0, last_s = 0;
  std::size_t rows = 0;

  void add(Stamp stamp) {
    const double t_s = stamp.seconds();
    first_s = rows == 0 ? t_s : std::min(first_s, t_s);
    last_s = rows == 0 ? t_s : std::max(last_s, t_s);
    ++rows;
  }
};

template <class Rows>
Recording recording_of(std::string file, const Rows& rows) {
  Recording recording{std::move(file)};
  for (const auto& row : rows) recording.add(row.stamp);
  return recording;
}

std::vector<Recording> recordings_of(const Mission& mission, std::size_t r) {
  const Robot& robot = mission.robots[r];
  std::vector<Recording> recordings{recording_of(robot_file(robot.id, "wifi.csv"), robot.wifi),
                                    recording_of(robot_file(robot.id, "imu.csv"), robot.inertial),
                                    recording_of(robot_file(robot.id, "gnss.csv"), robot.fixes)};
  Recording scans{robot_file(robot.id, "lidar")}, ranges{kRangesFile}, angles{kAnglesFile};
  for (const Stamp stamp : robot.lidar.stamps) scans.add(stamp);
  const RobotIndex index(r);
  for (const auto& range : mission.ranges)
    if (range.i.robot == index || range.j.robot == index) ranges.add(range.stamp);
  for (const auto& angle : mission.aoa_measurements)
    if (angle.receiver == index || angle.transmitter.robot == index) angles.add(angle.stamp);
  recordings.insert(recordings.end(), {scans, ranges, angles});
  return recordings;
}

/// The one of which most is outside the odometry; disjoint ones are on another clock.
void check_robot(const Mission& mission, std::size_t r, std::vector<Finding>& findings) {
  const Robot& robot = mission.robots[r];
  if (robot.odometry.size() < 2) return;
  const double begin_s = robot.odometry.front().stamp.seconds(),
               end_s = robot.odometry.back().stamp.seconds();
  double most_s = kMinMissing_s;
  std::optional<Recording> longest;
  for (Recording& recording : recordings_of(mission, r)) {
    const double missing_s =
        std::max(0.0, begin_s - recording.first_s) + std::max(0.0, recording.last_s - end_s);
    const double length_s = recording.last_s - recording.first_s;
    if (recording.rows < kMinRows || length_s > kMaxLengths * (end_s - begin_s) ||
        recording.first_s > end_s || recording.last_s < begin_s || missing_s < kMinMissingRatio * length_s ||
        missing_s < most_s)
      continue;
    most_s = missing_s;
    longest = std::move(recording);
  }
  if (!longest) return;
  findings.push_back(
      {"gap", Severity::kWarning, robot.id, odometry_file(robot.id),
       "poses from " + time_text(begin_s) + " to " + time_text(end_s) + " s only, while " + longest->file +
           " has rows from " + time_text(longest->first_s) + " to " + time_text(longest->last_s) + " s",
       "odometry for the whole recording",
       "check whether it was cut: " + number(most_s) + " s of what the robot recorded cannot be placed"});
}

}  // namespace

std::vector<Finding> check_odometry(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots)
    if (!robot.odometry.empty()) RobotCheck(mission, robot, findings).run();
  const auto same = [](const Robot& a, const Robot& b) { return same_recording(a.odometry, b.odometry); };
  add_duplicates(mission, same, odometry_file,
                 {"duplicate", Severity::kWarning, "", "", "the same motion as that of",
                  "a recording of its own", "remove one of the two, or replace it by the right recording"},
                 findings);
  return findings;
}

std::vector<Finding> check_odometry_coverage(const Mission& mission) {
  std::vector<Finding> findings;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) check_robot(mission, r, findings);
  return findings;
}

}  // namespace radioslam
