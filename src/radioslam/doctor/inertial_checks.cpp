#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/correlation.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kStep_s = 0.2;          // of the compared rates
constexpr std::size_t kMaxSteps = 4500;  // fifteen minutes
constexpr double kMaxLag_s = 60;
constexpr double kMinCorrelation = 0.6;
constexpr double kMinTurning_radps = 0.02;  // of a robot that shows anything

constexpr double kMinCentripetal_mps2 = 0.15;
constexpr double kMaxRate_radps = 12;  // of anything that drives or flies steadily

struct Rates {
  std::vector<Eigen::Vector3d> odometry, gyroscope;  ///< body frame, per step; NaN where unknown
  std::vector<Eigen::Vector3d> force;                ///< mean specific force, likewise
  std::vector<double> centripetal_mps2;              ///< forward speed times yaw rate of the odometry
};

/// Mean rate of rotation of the odometry, and of the gyroscope, on one grid of times.
Rates common_rates(const Robot& robot) {
  Rates rates;
  const double begin = robot.odometry.front().stamp.seconds();
  const double length = robot.odometry.back().stamp.seconds() - begin;
  const auto steps = std::min(kMaxSteps, static_cast<std::size_t>(std::max(0.0, length / kStep_s)));
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(std::nan(""));
  std::vector<double> counts(steps, 0);
  rates.gyroscope.assign(steps, Eigen::Vector3d::Zero());
  rates.force = rates.gyroscope;
  for (const ImuSample& sample : robot.inertial) {
    const double at = (sample.stamp.seconds() - begin) / kStep_s;
    if (at < 0 || at >= static_cast<double>(steps)) continue;
    rates.gyroscope[static_cast<std::size_t>(at)] += sample.angular_rate_radps;
    rates.force[static_cast<std::size_t>(at)] += sample.specific_force_mps2;
    counts[static_cast<std::size_t>(at)] += 1;
  }
  for (std::size_t k = 0; k < steps; ++k) {
    rates.gyroscope[k] = counts[k] > 0 ? Eigen::Vector3d(rates.gyroscope[k] / counts[k]) : unknown;
    rates.force[k] = counts[k] > 0 ? Eigen::Vector3d(rates.force[k] / counts[k]) : unknown;
    const auto a = robot.odometry.at(Stamp::from_seconds(begin + kStep_s * static_cast<double>(k)));
    const auto b = robot.odometry.at(Stamp::from_seconds(begin + kStep_s * static_cast<double>(k + 1)));
    const SE3 step = a && b ? a->inverse() * *b : SE3();
    rates.odometry.push_back(a && b ? Eigen::Vector3d(so3_log(step.rotation()) / kStep_s) : unknown);
    rates.centripetal_mps2.push_back(step.translation().x() / kStep_s * rates.odometry.back().z());
  }
  return rates;
}

/// Least squares of y = slope x + intercept, with the correlation.
struct Line {
  double correlation = 0, slope = 0, intercept = 0, sigma_x = 0, count = 0;
};

Line line_through(const Rates& rates, int odometry_axis, int gyroscope_axis, int lag) {
  CorrelationSums sums;
  for (std::size_t k = 0; k < rates.odometry.size(); ++k) {
    const auto at = static_cast<std::ptrdiff_t>(k) + lag;
    if (at < 0 || at >= std::ssize(rates.gyroscope)) continue;
    const double x = rates.odometry[k](odometry_axis),
                 y = rates.gyroscope[static_cast<std::size_t>(at)](gyroscope_axis);
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    sums.add(x, y);
  }
  Line line;
  const double vx = sums.spread_x(), vy = sums.spread_y(), vxy = sums.spread_xy();
  if (sums.n < 30 || vx <= 0 || vy <= 0) return line;
  line.count = sums.n;
  line.correlation = vxy / std::sqrt(vx * vy);
  line.slope = vxy / vx;
  line.intercept = (sums.y - line.slope * sums.x) / sums.n;
  line.sigma_x = std::sqrt(vx) / sums.n;
  return line;
}

struct Centripetal {
  double forward = 0, left = 0;  ///< correlation of ax and ay with what the odometry lets expect of ay
};

/// Nothing for a robot that does not drive curves.
std::optional<Centripetal> centripetal_of(const Rates& rates) {
  CorrelationSums forward, left;
  for (std::size_t k = 0; k < rates.force.size(); ++k) {
    const double expected = rates.centripetal_mps2[k];
    if (!std::isfinite(expected) || !std::isfinite(rates.force[k].x())) continue;
    forward.add(expected, rates.force[k].x());
    left.add(expected, rates.force[k].y());
  }
  if (left.n < 100 || std::sqrt(std::max(0.0, left.spread_x())) < kMinCentripetal_mps2 * left.n)
    return std::nullopt;
  const auto correlation = [](const CorrelationSums& sums) {
    const double spread = sums.spread_x() * sums.spread_y();
    return spread > 0 ? sums.spread_xy() / std::sqrt(spread) : 0;
  };
  return Centripetal{correlation(forward), correlation(left)};
}

/// Exceeded by a tenth of the samples.
double fast_rate_radps(const Robot& robot) {
  std::vector<double> rates;
  for (const ImuSample& sample : robot.inertial) rates.push_back(sample.angular_rate_radps.norm());
  const auto fast = rates.end() - static_cast<std::ptrdiff_t>(rates.size() / 10) - 1;
  std::nth_element(rates.begin(), fast, rates.end());
  return *fast;
}

class RobotInertial {
 public:
  RobotInertial(const Robot& robot, std::vector<Finding>& findings) : robot_(robot), findings_(findings) {}

  void run() {
    if (robot_.inertial.size() < 50) return;
    check_gravity();
    if (check_rates() || robot_.odometry.size() < 20) return;
    rates_ = common_rates(robot_);
    check_rotation();
    check_sides();
  }

 private:
  void add(const char* kind, Severity severity, std::string found, std::string expected, std::string advice) {
    // Only odometry from scans uses the IMU.
    if (robot_.lidar.empty()) severity = Severity::kWarning;
    findings_.push_back({kind, severity, robot_.id, robot_file(robot_.id, "imu.csv"), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  void check_gravity() {
    std::vector<double> norms;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const ImuSample& sample : robot_.inertial) {
      norms.push_back(sample.specific_force_mps2.norm());
      mean += sample.specific_force_mps2;
    }
    mean /= static_cast<double>(norms.size());
    const double typical = median(norms);
    const auto is_about = [&](double value) { return typical > 0.8 * value && typical < 1.25 * value; };
    if (is_about(9.81)) return check_up(mean);
    if (is_about(1) && mean.norm() > 0.8)
      return add("unit", Severity::kError, "the specific force is about 1", "about 9.81 m/s^2 at rest",
                 "multiply by 9.81: the values are in g");
    if (is_about(1000) || is_about(9810) || is_about(981))
      return add("unit", Severity::kError, "the specific force is about " + number(typical),
                 "about 9.81 m/s^2 at rest",
                 is_about(1000) ? "the values look like thousandths of g" : "convert to metres");
    if (typical < 5)
      return add("bias", Severity::kWarning, "the specific force is about " + number(typical) + " m/s^2",
                 "about 9.81 m/s^2 at rest", "do not remove gravity from the accelerations");
    add("unit", Severity::kWarning, "the specific force is about " + number(typical) + " m/s^2",
        "about 9.81 m/s^2 at rest", "check the unit of the accelerations");
  }

  /// Whether the gyroscope measures what nothing survives; also without odometry.
  bool check_rates() {
    const double fast = fast_rate_radps(robot_);
    if (fast < kMaxRate_radps) return false;
    add("unit", Severity::kError, "a tenth of the angular rates is above " + number(fast), "rad/s",
        "multiply by pi/180: the values look like degrees per second");
    return true;
  }

  /// Centripetal acceleration, which a forward-driving body measures along y.
  void check_sides() {
    const auto sides = centripetal_of(rates_);
    if (!sides) return;
    if (std::abs(sides->forward) > 0.7 && std::abs(sides->left) < 0.3)
      add("column-order", Severity::kWarning,
          "ax measures the centripetal acceleration of curves (correlation " + number(sides->forward) + ")",
          "ay, to the left of the body", "exchange ax and ay, or turn the readings into the body frame");
    if (sides->left < -0.7)
      add("handedness", Severity::kWarning, "ay measures curves with the wrong sign", "y to the left",
          "change the sign of ay_mps2, or turn the readings into the body frame");
  }

  /// Gravity along the body's z, where the odometry's body is level.
  void check_up(const Eigen::Vector3d& mean) {
    if (mean.z() > 0.7 * mean.norm() || mean.norm() < 5) return;
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    for (const auto& row : robot_.odometry) up += row.pose.rotation().inverse() * Eigen::Vector3d::UnitZ();
    if (up.z() < 0.8 * static_cast<double>(std::max<std::size_t>(1, robot_.odometry.size()))) return;
    if (mean.z() < -0.7 * mean.norm())
      return add("handedness", Severity::kError,
                 "gravity points up: the z axis measures " + number(mean.z()) + " m/s^2",
                 "z up, +9.81 m/s^2 at rest", "turn the readings into a frame with z up");
    add("column-order", Severity::kError,
        "gravity lies along (" + number(mean.x()) + ", " + number(mean.y()) + ", " + number(mean.z()) +
            ") m/s^2",
        "along z of the body, which the odometry says is level",
        "exchange the columns, or turn the readings into the body frame");
  }

  /// The gyroscope against the odometry's rate of rotation.
  void check_rotation() {
    const Line now = line_through(rates_, 2, 2, 0);
    if (now.count == 0 || now.sigma_x < kMinTurning_radps) return;
    if (now.correlation > 0.8) return check_scale_and_bias(now);
    if (now.correlation < -kMinCorrelation)
      return add("handedness", Severity::kError, "wz turns the other way than the odometry",
                 "counter-clockwise about z", "change the sign of wz_radps, or of the odometry's yaw");
    const auto [lag, line] = best_lag();
    if (std::abs(line.correlation) > std::max(kMinCorrelation, std::abs(now.correlation) + 0.15) && lag != 0)
      return report_clock(lag, now, line);
    for (const int axis : {0, 1}) {
      const Line other = line_through(rates_, 2, axis, 0);
      if (std::abs(other.correlation) < 0.8) continue;
      return add("column-order", Severity::kError,
                 std::string("w") + "xy"[axis] + " turns as the odometry's yaw does, wz does not",
                 "wz about the vertical axis",
                 "exchange the columns, or turn the readings into the body frame");
    }
    if (std::abs(now.correlation) < 0.2 && now.sigma_x > 5 * kMinTurning_radps)
      add("frame", Severity::kWarning,
          "the gyroscope does not turn with the odometry (correlation " + number(now.correlation) + ")",
          "rates of the same body", "check the clock, the axes and the unit");
  }

  void report_clock(int lag, const Line& now, const Line& line) {
    const double seconds = lag * kStep_s;
    add("clock", std::abs(seconds) > 2 ? Severity::kError : Severity::kWarning,
        "rotations are " + number(std::abs(seconds)) + " s " + (seconds > 0 ? "late" : "early") +
            " (correlation " + number(line.correlation) + " instead of " + number(now.correlation) + ")",
        "the clock of the odometry", "subtract " + number(seconds) + " s from t_s");
  }

  std::pair<int, Line> best_lag() const {
    std::pair<int, Line> best{0, line_through(rates_, 2, 2, 0)};
    const double least_count = 0.3 * best.second.count;
    const int last = static_cast<int>(kMaxLag_s / kStep_s);
    for (int lag = -last; lag <= last; ++lag) {
      const Line line = line_through(rates_, 2, 2, lag);
      if (line.count > least_count && std::abs(line.correlation) > std::abs(best.second.correlation) + 1e-9)
        best = {lag, line};
    }
    return best;
  }

  void check_scale_and_bias(const Line& line) {
    if (line.slope > 20 || line.slope < 0.1)
      return add(
          "unit", Severity::kError, "rates are " + number(line.slope) + " times those of the odometry",
          "rad/s",
          line.slope > 20 ? "multiply by pi/180: the values are in degrees per second" : "check the unit");
    if (std::abs(line.slope - 1) > 0.25)
      add("unit", Severity::kWarning, "rates are " + number(line.slope) + " times those of the odometry",
          "rad/s", "check the scale");
    if (std::abs(line.intercept) > 0.05)
      add("bias", Severity::kWarning,
          "wz has a constant error of " + number(line.intercept) + " rad/s against the odometry",
          "a bias below 0.05 rad/s", "subtract it from wz_radps");
  }

  const Robot& robot_;
  std::vector<Finding>& findings_;
  Rates rates_;
};

}  // namespace

std::vector<Finding> check_inertial(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots) RobotInertial(robot, findings).run();
  return findings;
}

}  // namespace radioslam
