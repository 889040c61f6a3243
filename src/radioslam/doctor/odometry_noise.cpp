#include "radioslam/doctor/odometry_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/correlation.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kMaxStep_s = 0.55;
constexpr std::size_t kMinWindows = 200, kMaxSteps = 20000;
constexpr double kMedianOfSquare = 0.455;               // of a standard normal variable
constexpr double kMinGrowth = 0.65, kMaxGrowth = 1.55;  // of the variance per metre, from m to 2 m steps
constexpr double kMaxRatio = 5;                         // of measured to stated sigma
constexpr double kMinSigma_per_sqrt_m = 0.003;          // of any odometry

struct SideStep {
  double length_m, side_m;
};

/// Steps in the body frame, without what is proportional to length times turn.
std::vector<SideStep> side_steps(const Trajectory<SE3>& odometry) {
  std::vector<SideStep> steps;
  std::vector<double> turned_m;
  CorrelationSums sums;
  for (std::size_t k = 1; k < std::min(odometry.size(), kMaxSteps); ++k) {
    const SE3 step = odometry[k - 1].pose.inverse() * odometry[k].pose;
    const double length_m = step.translation().norm();
    steps.push_back({length_m, step.translation().y()});
    turned_m.push_back(step.translation().x() * step.yaw());
    sums.add(turned_m.back(), steps.back().side_m);
  }
  const double slope = sums.xx > 0 ? sums.xy / sums.xx : 0;
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].side_m -= slope * turned_m[k];
  return steps;
}

double median_step_s(const Trajectory<SE3>& odometry) {
  std::vector<double> steps_s;
  for (std::size_t k = 1; k < odometry.size(); ++k)
    steps_s.push_back(seconds_between(odometry[k - 1].stamp, odometry[k].stamp));
  return median(steps_s);
}

/// Variance per metre from differences of adjacent windows of `m` moving steps.
std::optional<double> variance_per_m(const std::vector<SideStep>& steps, std::size_t m) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k + 2 * m <= steps.size(); ++k) {
    double difference_m = 0, path_m = 0;
    bool is_moving = true;
    for (std::size_t at = 0; at < 2 * m; ++at) {
      const SideStep& step = steps[k + at];
      difference_m += at < m ? -step.side_m : step.side_m;
      path_m += step.length_m;
      is_moving = is_moving && step.length_m > 0.005;
    }
    if (is_moving) ratios.push_back(difference_m * difference_m / path_m);
  }
  if (ratios.size() < kMinWindows) return std::nullopt;
  return median(ratios) / kMedianOfSquare;
}

Finding contradicted(const Robot& robot, double measured) {
  return {"noise",
          Severity::kWarning,
          robot.id,
          "mission.yaml",
          "the odometry of robot '" + robot.id + "' is noisier than stated: its steps scatter by " +
              number(measured) + " m sideways per square root of a metre",
          "sigma_xy_per_sqrt_m " + number(robot.odometry_noise.sigma_xy_per_sqrt_m) + " as stated",
          "state larger sigmas of the odometry"};
}

}  // namespace

std::optional<double> measured_sigma_xy_per_sqrt_m(const Trajectory<SE3>& odometry) {
  if (odometry.size() <= kMinWindows || median_step_s(odometry) > kMaxStep_s) return std::nullopt;
  const std::vector<SideStep> steps = side_steps(odometry);
  std::array<double, 3> variances{};
  for (std::size_t k = 0; k < variances.size(); ++k) {
    const auto variance = variance_per_m(steps, std::size_t{1} << k);
    if (!variance || *variance <= 0) return std::nullopt;
    variances[k] = *variance;
    if (k > 0 &&
        (variances[k] < kMinGrowth * variances[k - 1] || variances[k] > kMaxGrowth * variances[k - 1]))
      return std::nullopt;
  }
  return std::sqrt(*std::min_element(variances.begin(), variances.end()));
}

std::vector<Finding> check_odometry_noise(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots) {
    if (robot.odometry.empty() || !robot.odometry_noise.steps.empty()) continue;
    const auto measured = measured_sigma_xy_per_sqrt_m(robot.odometry);
    if (measured && *measured > kMinSigma_per_sqrt_m &&
        *measured > kMaxRatio * robot.odometry_noise.sigma_xy_per_sqrt_m)
      findings.push_back(contradicted(robot, *measured));
  }
  return findings;
}

}  // namespace radioslam
