#include "radioslam/team_frame/fix_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

/// At most `most` of the fixes, evenly spread.
std::vector<FixAlongPath> some_fixes(const std::vector<FixAlongPath>& fixes, int most) {
  const auto n = static_cast<std::size_t>(most);
  if (fixes.size() <= n) return fixes;
  std::vector<FixAlongPath> kept;
  for (std::size_t k = 0; k < n; ++k) kept.push_back(fixes[k * (fixes.size() - 1) / (n - 1)]);
  return kept;
}

Eigen::Vector2d plane(const Eigen::Vector3d& point) { return point.head<2>(); }

/// Alignment by two fixes; nothing if they contradict odometry or are too close to give a direction.
std::optional<SE2> place_by_two(const FixAlongPath& a, const FixAlongPath& b,
                                const FixAlignmentParams& params) {
  const Eigen::Vector2d by_odometry = plane(b.by_odometry_m) - plane(a.by_odometry_m);
  const Eigen::Vector2d by_fixes = plane(b.position_m) - plane(a.position_m);
  const double noise_m = std::hypot(a.sigma_m, b.sigma_m);
  const double drift_m = params.max_drift_ratio * std::abs(b.path_m - a.path_m);
  if (by_odometry.norm() < noise_m || by_fixes.norm() < noise_m ||
      std::abs(by_odometry.norm() - by_fixes.norm()) > params.gate_sigma * std::hypot(noise_m, drift_m))
    return std::nullopt;
  const double yaw = std::atan2(by_fixes.y(), by_fixes.x()) - std::atan2(by_odometry.y(), by_odometry.x());
  const SE2 turn(Eigen::Vector2d::Zero(), yaw);
  const Eigen::Vector2d odometry_middle = (plane(a.by_odometry_m) + plane(b.by_odometry_m)) / 2;
  const Eigen::Vector2d fixes_middle = (plane(a.position_m) + plane(b.position_m)) / 2;
  return SE2(fixes_middle - turn * odometry_middle, yaw);
}

/// Negative log likelihood up to a constant.
double cost_of(const SE2& T_fixes_start, const FixAlongPath& a, const FixAlongPath& b,
               const std::vector<FixAlongPath>& fixes, double max_drift_ratio) {
  double cost = 0;
  for (const FixAlongPath& fix : fixes) {
    const double path_m = std::min(std::abs(fix.path_m - a.path_m), std::abs(fix.path_m - b.path_m));
    const double width = std::hypot(fix.sigma_m, max_drift_ratio * path_m);
    const Eigen::Vector2d left = plane(fix.position_m) - T_fixes_start * plane(fix.by_odometry_m);
    cost += std::log(width) + std::log1p(left.squaredNorm() / (width * width));
  }
  return cost;
}

double median_height_m(const std::vector<FixAlongPath>& fixes) {
  std::vector<double> heights;
  for (const FixAlongPath& fix : fixes) heights.push_back(fix.position_m.z() - fix.by_odometry_m.z());
  return upper_median(std::move(heights));
}

}  // namespace

std::optional<FixAlignment> align_by_fixes(const std::vector<FixAlongPath>& fixes,
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
      const double cost = cost_of(*place, tried[i], tried[j], scored, params.max_drift_ratio);
      if (cost >= least) continue;
      least = cost;
      best = FixAlignment{lift(*place, height_m), tried[i].path_m, tried[j].path_m};
    }
  return best;
}

}  // namespace radioslam
