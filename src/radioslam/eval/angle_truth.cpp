#include "radioslam/eval/angle_truth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/units.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {
namespace {

constexpr double kSigmas = 3;
constexpr double kSlack_rad = 5 * kRadiansPerDegree;

bool points_to(const AoaPath& path, const Eigen::Vector3d& direction) {
  const double horizontal = std::hypot(direction.x(), direction.y());
  const double azimuth_error =
      std::remainder(std::atan2(direction.y(), direction.x()) - path.azimuth_rad, 2 * std::numbers::pi);
  const double elevation_error =
      path.elevation_rad ? std::atan2(direction.z(), horizontal) - *path.elevation_rad : 0;
  return std::hypot(azimuth_error, elevation_error) <= kSigmas * path.sigma_rad + kSlack_rad;
}

}  // namespace

std::optional<std::size_t> likeliest_path(const std::vector<double>& weights, std::size_t paths) {
  if (paths == 1) return 0;
  if (weights.size() != paths || paths == 0) return std::nullopt;
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

AngleTruth judge_path(std::size_t path, int direct_path) {
  if (direct_path == kNoDirectPath) return AngleTruth::kNoneDirect;
  return static_cast<int>(path) == direct_path ? AngleTruth::kDirectFound : AngleTruth::kWrongPath;
}

AngleTruth judge_path(std::size_t path, const std::vector<AoaPath>& paths, const Eigen::Vector3d& direction) {
  if (points_to(paths[path], direction)) return AngleTruth::kDirectFound;
  const bool other_is_direct =
      std::any_of(paths.begin(), paths.end(), [&](const AoaPath& p) { return points_to(p, direction); });
  return other_is_direct ? AngleTruth::kWrongPath : AngleTruth::kNoneDirect;
}

}  // namespace radioslam
