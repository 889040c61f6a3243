#include "radioslam/doctor/odometry_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/duplicates.hpp"
#include "radioslam/doctor/frame_checks.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

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

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
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

}  // namespace radioslam
