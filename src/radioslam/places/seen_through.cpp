#include "radioslam/places/seen_through.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/evenly_chosen.hpp"
#include "radioslam/lidar/structure_fit.hpp"

namespace radioslam {
namespace {

constexpr int kColumns = 180, kRows = 90;  // 2 degrees
constexpr std::size_t kMinReturns = 2;     // around a direction that was looked in
constexpr float kMinRange_m = 0.5F;
constexpr double kReachQuantile = 0.9;
constexpr float kMinTolerance_m = 0.5F;
constexpr double kMaxSigma_m = 0.5;        // of a relative pose, beyond which structures are confused
constexpr std::size_t kMaxPoints = 60;     // of a keyframe
constexpr std::size_t kMaxKeyframes = 40;  // of a robot, evenly chosen
constexpr double kUpright = 0.5;           // share of a surfel's information in the plane

std::vector<std::size_t> compared_keyframes(const PlacedKeyframes& robot) {
  std::vector<std::size_t> with_scan;
  for (std::size_t k = 0; k < robot.poses.size(); ++k)
    if (!robot.keyframes.clouds[k].empty()) with_scan.push_back(k);
  return evenly_chosen(std::move(with_scan), kMaxKeyframes);
}

Eigen::Isometry3f isometry(const SE3& T) {
  Eigen::Isometry3f result = Eigen::Isometry3f::Identity();
  result.linear() = T.rotation_matrix().cast<float>();
  result.translation() = T.translation().cast<float>();
  return result;
}

/// Points that determine a position, of walls and poles.
std::vector<Eigen::Vector3f> structure_points(const ScanPyramid& scan, ScannerKind kind) {
  std::vector<Eigen::Vector3f> points;
  for (const Surfel& surfel : scan.all)
    if (kind == ScannerKind::kPlanar || horizontal_share(surfel) > kUpright)
      points.push_back(surfel.position);
  return evenly_chosen(std::move(points), kMaxPoints);
}

struct Placed {
  SE3 T_a_b;
  double sigma_m;
};

/// Keyframe k of b from keyframe m of a, by the nearest shared place along both paths.
Placed placed(const PlacedKeyframes& a, std::size_t m, const PlacedKeyframes& b, std::size_t k,
              const std::vector<SharedPlace>& places) {
  const auto way_m = [&](const SharedPlace& place) {
    return std::abs(a.path_m[m] - a.path_m[place.i]) + std::abs(b.path_m[k] - b.path_m[place.j]);
  };
  const auto nearest = std::min_element(places.begin(), places.end(),
                                        [&](const auto& x, const auto& y) { return way_m(x) < way_m(y); });
  const double sigma_m = std::hypot(a.sigma_m(m, nearest->i), b.sigma_m(nearest->j, k), nearest->sigma_m);
  return {a.poses[m].inverse() * a.poses[nearest->i] * nearest->T_i_j * b.poses[nearest->j].inverse() *
              b.poses[k],
          sigma_m};
}

/// Points of b in the views of a.
void count(const PlacedKeyframes& a, const PlacedKeyframes& b, const std::vector<SharedPlace>& places,
           SeenThrough& counts) {
  const std::vector<std::size_t> of_b = compared_keyframes(b);
  std::vector<std::vector<Eigen::Vector3f>> points;
  for (const std::size_t k : of_b)
    points.push_back(structure_points(*b.keyframes.clouds[k].read(), b.keyframes.kind));
  for (const std::size_t m : compared_keyframes(a)) {
    const Panorama view(*a.keyframes.clouds[m].read(), a.keyframes.kind);
    for (std::size_t n = 0; n < of_b.size(); ++n) {
      const Placed at = placed(a, m, b, of_b[n], places);
      if (at.sigma_m > kMaxSigma_m) continue;
      const float tolerance_m = std::max(kMinTolerance_m, static_cast<float>(3 * at.sigma_m));
      const Eigen::Isometry3f T_a_b = isometry(at.T_a_b);
      for (const Eigen::Vector3f& point : points[n]) {
        const auto seen = view.of(T_a_b * point, tolerance_m);
        if (seen == Panorama::View::kSeen) ++counts.seen;
        if (seen == Panorama::View::kThrough) ++counts.through;
      }
    }
  }
}

}  // namespace

Panorama::Panorama(const ScanPyramid& scan, ScannerKind kind) : kind_(kind), ranges_m_(kColumns * kRows) {
  std::vector<float> all;
  for (const Surfel& surfel : scan.all) {
    const Direction at = direction(surfel.position);
    if (at.range_m < kMinRange_m) continue;
    ranges_m_[static_cast<std::size_t>(at.row * kColumns + at.column)].push_back(at.range_m);
    all.push_back(at.range_m);
  }
  if (all.empty()) return;
  const auto reach =
      all.begin() + static_cast<std::ptrdiff_t>(kReachQuantile * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), reach, all.end());
  reach_m_ = *reach;
}

Panorama::Direction Panorama::direction(const Eigen::Vector3f& point) const {
  using std::numbers::pi_v;
  const auto bin = [](float angle, float whole, int bins) {
    return std::clamp(static_cast<int>((angle / whole) * static_cast<float>(bins)), 0, bins - 1);
  };
  const float azimuth = std::atan2(point.y(), point.x()) + pi_v<float>;
  const int column = bin(azimuth, 2 * pi_v<float>, kColumns);
  if (kind_ == ScannerKind::kPlanar) return {column, 0, point.head<2>().norm()};
  const float elevation = std::atan2(point.z(), point.head<2>().norm()) + pi_v<float> / 2;
  return {column, bin(elevation, pi_v<float>, kRows), point.norm()};
}

Panorama::View Panorama::of(const Eigen::Vector3f& point, float tolerance_m) const {
  const Direction at = direction(point);
  if (at.range_m < kMinRange_m || at.range_m > reach_m_) return View::kNothing;
  std::size_t returns = 0;
  bool is_through = true;
  for (int row = std::max(0, at.row - 1); row <= std::min(kRows - 1, at.row + 1); ++row)
    for (int step = -1; step <= 1; ++step) {
      const int column = (at.column + step + kColumns) % kColumns;
      for (const float range_m : ranges_m_[static_cast<std::size_t>(row * kColumns + column)]) {
        if (std::abs(range_m - at.range_m) <= tolerance_m) return View::kSeen;
        is_through = is_through && range_m > at.range_m;
        ++returns;
      }
    }
  return is_through && returns >= kMinReturns ? View::kThrough : View::kNothing;
}

SeenThrough seen_through(const PlacedKeyframes& a, const PlacedKeyframes& b,
                         const std::vector<SharedPlace>& places) {
  RADIOSLAM_CHECK(!places.empty(), "robots share a place");
  std::vector<SharedPlace> back;
  for (const auto& [i, j, T_i_j, sigma_m] : places) back.push_back({j, i, T_i_j.inverse(), sigma_m});
  SeenThrough counts;
  count(a, b, places, counts);
  count(b, a, back, counts);
  return counts;
}

}  // namespace radioslam
