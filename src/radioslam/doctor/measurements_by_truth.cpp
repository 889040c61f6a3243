// Stated starts and ranges between robots against the ground truth.
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/doctor/quantile.hpp"
#include "radioslam/doctor/starts.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/doctor/truth_fit.hpp"

namespace radioslam {
namespace {

/// Of a pair of starts against the truth.
constexpr double kSigmaStart_m = 1.3, kSigmaStart_rad = 0.1;
constexpr std::size_t kMinRanges = 10;
constexpr double kMinBias_m = 0.3;                        // that four fifths of the ranges exceed
constexpr double kMaxSpreadSigmas = 3, kMaxSpread = 0.3;  // of the middle half, of the bias

/// Known starts of robots whose truth fits, against its relative poses.
void check_starts(const Mission& mission, const std::vector<std::optional<SE3>>& T_truth_start,
                  std::vector<Finding>& findings) {
  std::vector<PairOfStarts> pairs;
  for (std::size_t j = 1; j < mission.robots.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      const auto &a = mission.robots[i].initial_pose, &b = mission.robots[j].initial_pose;
      if (!a || !b || !T_truth_start[i] || !T_truth_start[j]) continue;
      const SE3 stated = a->inverse() * *b, found = T_truth_start[i]->inverse() * *T_truth_start[j];
      const StartError error{stated.inverse() * found, kSigmaStart_m, kSigmaStart_rad};
      pairs.push_back({i, j, error.is_far() ? std::optional(error) : std::nullopt});
    }
  for (Finding& finding : start_findings(mission, pairs, "the ground truth"))
    findings.push_back(std::move(finding));
}

struct Residuals {
  std::vector<double> m;
  double sigma_m = 0;
};

/// Ranges between robots that mostly differ from the true distances by the same.
void check_ranges(const Mission& mission, const Truth& truth,
                  const std::vector<std::optional<SE3>>& T_truth_start, std::vector<Finding>& findings) {
  std::map<std::pair<std::size_t, std::size_t>, Residuals> of_pair;
  const auto place = [&](const LinkEnd& end, Stamp stamp) -> std::optional<Eigen::Vector3d> {
    if (!end.robot.valid() || !T_truth_start[end.robot.index()]) return std::nullopt;
    const RobotTruth& robot = truth.robots[end.robot.index()];
    const auto pose = robot.poses.at(stamp);
    if (!pose || (!robot.has_orientation && !end.lever_arm_m.isZero())) return std::nullopt;
    return *pose * end.lever_arm_m;
  };
  for (const RangeMeasurement& range : mission.ranges) {
    const auto a = place(range.i, range.stamp), b = place(range.j, range.stamp);
    if (!a || !b) continue;
    Residuals& residuals = of_pair[std::minmax(range.i.robot.index(), range.j.robot.index())];
    residuals.m.push_back(range.range_m - (*b - *a).norm());
    residuals.sigma_m = std::max(residuals.sigma_m, range.sigma_m);
  }
  for (auto& [pair, residuals] : of_pair) {
    if (residuals.m.size() < kMinRanges) continue;
    const double middle = quantile(residuals.m, 0.5);
    const bool is_long = quantile(residuals.m, 0.2) > kMinBias_m,
               is_short = quantile(residuals.m, 0.8) < -kMinBias_m;
    const double spread = quantile(residuals.m, 0.75) - quantile(residuals.m, 0.25);
    if ((!is_long && !is_short) ||
        spread > std::max(kMaxSpreadSigmas * residuals.sigma_m, kMaxSpread * std::abs(middle)))
      continue;
    findings.push_back({"bias", Severity::kWarning, "", kRangesFile,
                        "distances between " + mission.robots[pair.first].id + " and " +
                            mission.robots[pair.second].id + " are about " + number(std::abs(middle)) +
                            " m too " + (is_long ? "long" : "short") + " by the ground truth",
                        "unbiased distances", "subtract the antenna delay, about " + number(middle) + " m"});
  }
}

}  // namespace

void check_by_truth(const Mission& mission, const Truth& truth,
                    const std::vector<std::optional<SE3>>& T_truth_start, std::vector<Finding>& findings) {
  check_starts(mission, T_truth_start, findings);
  check_ranges(mission, truth, T_truth_start, findings);
}

}  // namespace radioslam
