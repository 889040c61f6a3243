#include "radioslam/places/loops/other_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kCovered = 2;     // standard deviations around a prediction that its search covers
constexpr std::size_t kAlike = 6;  // places that look alike and are searched
constexpr std::size_t kOtherStoreys = 2;
constexpr double kSigmaPlace = 1.0 / 3;  // of a scan from the place that looks alike, in its median range
constexpr double kSigmaStorey_m = 1, kSigmaStorey_rad = 0.1;  // of a scan from its place on another storey

/// Whether a keyframe of the target may show where the scan is, other than by having been there with it:
/// what hangs on j itself shows the scan where it is, wherever that may be.
bool may_show(const ComparedKeyframes& of, std::size_t k, double reach_m) {
  if (!of.target.has_cloud(k)) return false;
  return !of.are_of_one_robot() || (k != of.j && kPossibleSigmas * of.target.sigma_m(of.j, k) > reach_m);
}

/// Whether a search around the one finds the other.
bool is_near(const SE3& a, const SE3& b, const SE3::Jacobian& covariance) {
  const SE3::Tangent off = (a.inverse() * b).log();
  return off.dot(ldlt_solve(covariance, off)) <= kCovered * kCovered;
}

std::optional<std::size_t> nearest_keyframe(const ComparedKeyframes& of, const Eigen::Vector3d& position,
                                            double reach_m) {
  std::optional<std::size_t> nearest;
  double nearest_m = reach_m;
  for (std::size_t k = 0; k < of.target.poses.size(); ++k) {
    const double distance_m = (of.target.poses[k].translation() - position).norm();
    if (distance_m >= nearest_m || !may_show(of, k, reach_m)) continue;
    nearest = k;
    nearest_m = distance_m;
  }
  return nearest;
}

}  // namespace

std::vector<OtherPlace> places_expected(const ComparedKeyframes& compared, const ExpectedPlace& expected,
                                        double reach_m, double min_share) {
  const PlacedKeyframes& target = compared.target;
  std::vector<OtherPlace> places;
  std::vector<SE3> searched{expected.T_i_j.pose};
  for (const auto& [T_i_j, weight] : expected.alternatives) {
    if (weight < min_share * expected.weight) continue;
    const auto covers = [&, &T = T_i_j](const SE3& other) {
      return is_near(other, T, expected.T_i_j.covariance);
    };
    if (std::any_of(searched.begin(), searched.end(), covers)) continue;
    searched.push_back(T_i_j);
    const SE3 T_target_j = target.poses[compared.i] * T_i_j;
    const auto k = nearest_keyframe(compared, T_target_j.translation(), reach_m);
    if (!k) continue;
    const double sigma_m = target.sigma_m(compared.i, *k);
    places.push_back({*k,
                      {target.poses[*k].inverse() * T_target_j,
                       expected.T_i_j.covariance + isotropic(sigma_m * sigma_m, 0)}});
  }
  return places;
}

std::vector<OtherPlace> places_alike(const ComparedKeyframes& compared, double reach_m, double apart_m,
                                     const std::vector<OtherPlace>& except) {
  const PlacedKeyframes& target = compared.target;
  const ScanContext& context = compared.source.index->context(compared.j);
  std::vector<std::size_t> known{compared.i};
  for (const OtherPlace& place : except) known.push_back(place.keyframe);
  const auto is_new = [&](std::size_t k) {
    return may_show(compared, k, reach_m) && std::none_of(known.begin(), known.end(), [&](std::size_t other) {
             return std::abs(target.path_m[k] - target.path_m[other]) < apart_m;
           });
  };
  std::vector<OtherPlace> places;
  while (places.size() < kAlike) {
    const auto found = target.index->nearest(context, 1, is_new);
    if (found.empty()) break;
    known.push_back(found.front().index);
    places.push_back(
        {found.front().index, described_pose(target.keyframes, found.front(), context.sectors())});
  }
  return places;
}

std::vector<OtherPlace> places_on_other_storeys(const ComparedKeyframes& compared, const SE3& T_i_j,
                                                double storey_m, double reach_m) {
  const PlacedKeyframes& target = compared.target;
  const SE3 T_target_j = target.poses[compared.i] * T_i_j;
  const auto height_m = [&](std::size_t k) { return target.poses[k].translation().z(); };
  std::vector<std::pair<double, std::size_t>> by_distance;
  for (std::size_t k = 0; k < target.poses.size(); ++k) {
    const double distance_m = (target.poses[k].translation() - T_target_j.translation()).head<2>().norm();
    if (distance_m > reach_m || std::abs(height_m(k) - height_m(compared.i)) < storey_m) continue;
    if (may_show(compared, k, reach_m)) by_distance.emplace_back(distance_m, k);
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<OtherPlace> places;
  for (const auto& [distance_m, k] : by_distance) {
    if (places.size() == kOtherStoreys) break;
    const auto is_same_storey = [&, k = k](const OtherPlace& other) {
      return std::abs(height_m(k) - height_m(other.keyframe)) < storey_m;
    };
    if (std::any_of(places.begin(), places.end(), is_same_storey)) continue;
    const double higher_m = height_m(k) - height_m(compared.i), sigma_m = target.sigma_m(compared.i, k);
    if (std::abs(higher_m) < 2 * sigma_m) continue;
    const SE3 T_target_there(T_target_j.translation() + Eigen::Vector3d(0, 0, higher_m),
                             T_target_j.rotation());
    const double wide_m = std::hypot(kSigmaStorey_m, sigma_m);
    places.push_back({k,
                      {target.poses[k].inverse() * T_target_there,
                       isotropic(wide_m * wide_m, kSigmaStorey_rad * kSigmaStorey_rad)}});
  }
  return places;
}

UncertainPose<SE3> described_pose(const ScanKeyframes& keyframes, const Neighbour& found, int sectors) {
  const double sigma_m = kSigmaPlace * keyframes.clouds[found.index].median_range_m();
  const double sigma_rad = 2 * std::numbers::pi / sectors;
  // compare(query, context): p_query = Rz(yaw) p_context.
  const Eigen::AngleAxisd turn(-found.match.yaw_rad, Eigen::Vector3d::UnitZ());
  return {SE3(Eigen::Vector3d::Zero(), Eigen::Quaterniond(turn)),
          isotropic(sigma_m * sigma_m, sigma_rad * sigma_rad)};
}

}  // namespace radioslam
