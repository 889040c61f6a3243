#include "radioslam/team_frame/fix_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

/// At most `most` of them, evenly spread.
std::vector<FixOfWay> some_fixes(const std::vector<FixOfWay>& fixes, int most) {
  const auto n = static_cast<std::size_t>(most);
  if (fixes.size() <= n) return fixes;
  std::vector<FixOfWay> kept;
  for (std::size_t k = 0; k < n; ++k) kept.push_back(fixes[k * (fixes.size() - 1) / (n - 1)]);
  return kept;
}

Eigen::Vector2d plane(const Eigen::Vector3d& point) { return point.head<2>(); }

/// By two fixes; nothing where they contradict the odometry or give no direction.
std::optional<SE2> place_by_two(const FixOfWay& a, const FixOfWay& b, const FixAlignmentParams& params) {
  const Eigen::Vector2d walked = plane(b.by_odometry_m) - plane(a.by_odometry_m);
  const Eigen::Vector2d fixed = plane(b.position_m) - plane(a.position_m);
  const double noise_m = std::hypot(a.sigma_m, b.sigma_m);
  const double drift_m = params.drift_share * std::abs(b.way_m - a.way_m);
  if (walked.norm() < noise_m || fixed.norm() < noise_m ||
      std::abs(walked.norm() - fixed.norm()) > params.gate_sigma * std::hypot(noise_m, drift_m))
    return std::nullopt;
  const double yaw = std::atan2(fixed.y(), fixed.x()) - std::atan2(walked.y(), walked.x());
  const SE2 turn(Eigen::Vector2d::Zero(), yaw);
  const Eigen::Vector2d walked_middle = (plane(a.by_odometry_m) + plane(b.by_odometry_m)) / 2;
  const Eigen::Vector2d fixed_middle = (plane(a.position_m) + plane(b.position_m)) / 2;
  return SE2(fixed_middle - turn * walked_middle, yaw);
}

/// The negative logarithm of the likelihood, up to a constant.
double cost_of(const SE2& T_fixes_start, const FixOfWay& a, const FixOfWay& b,
               const std::vector<FixOfWay>& fixes, double drift_share) {
  double cost = 0;
  for (const FixOfWay& fix : fixes) {
    const double way_m = std::min(std::abs(fix.way_m - a.way_m), std::abs(fix.way_m - b.way_m));
    const double width = std::hypot(fix.sigma_m, drift_share * way_m);
    const Eigen::Vector2d left = plane(fix.position_m) - T_fixes_start * plane(fix.by_odometry_m);
    cost += std::log(width) + std::log1p(left.squaredNorm() / (width * width));
  }
  return cost;
}

double median_height_m(const std::vector<FixOfWay>& fixes) {
  std::vector<double> heights;
  for (const FixOfWay& fix : fixes) heights.push_back(fix.position_m.z() - fix.by_odometry_m.z());
  return upper_median(std::move(heights));
}

}  // namespace

std::optional<FixAlignment> align_by_fixes(const std::vector<FixOfWay>& fixes,
                                           const FixAlignmentParams& params) {
  const auto tried = some_fixes(fixes, params.tried_fixes);
  const auto scored = some_fixes(fixes, params.scored_fixes);
  std::optional<FixAlignment> best;
  const double height_m = fixes.empty() ? 0 : median_height_m(fixes);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tried.size(); ++i)
    for (std::size_t j = i + 1; j < tried.size(); ++j) {
      const auto place = place_by_two(tried[i], tried[j], params);
      if (!place) continue;
      const double cost = cost_of(*place, tried[i], tried[j], scored, params.drift_share);
      if (cost >= least) continue;
      least = cost;
      best = FixAlignment{lift(*place, height_m), tried[i].way_m, tried[j].way_m};
    }
  return best;
}

}  // namespace radioslam
