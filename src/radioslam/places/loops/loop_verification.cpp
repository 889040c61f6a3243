#include "radioslam/places/loops/loop_verification.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/lidar/structure_fit.hpp"
#include "radioslam/places/keyframe_contexts.hpp"
#include "radioslam/places/loops/alternatives.hpp"
#include "radioslam/places/loops/storey.hpp"

namespace radioslam {
namespace {

constexpr double kBeyond =
    4.0 / 3;  // how far alternatives are searched, in the width of a search for the place
constexpr double kSamePlace_m = 1;
constexpr double kStoreyPrior = 0.1;  // that there is a storey that looks the same

/// What the points do not observe is known to a hundred metres and radians.
SE3::Jacobian covariance_of_fit(const Registration& fit) {
  constexpr double kLeast = 1e-4;
  return inverse<SE3::Jacobian>((fit.information + fit.information.transpose()) / 2 +
                                kLeast * SE3::Jacobian::Identity());
}

double sigma_in_plane(const UncertainPose<SE3>& T) {
  const Eigen::Matrix3d covariance = T.position_covariance();
  return std::sqrt(symmetric_eigen<Eigen::Matrix2d>(covariance.topLeftCorner<2, 2>()).values.maxCoeff());
}

/// Area that a robot has seen on its way.
double seen_area_m2(const PlacedKeyframes& robot, double range_m) {
  double way_m = 0;
  for (std::size_t k = 1; k < robot.poses.size(); ++k)
    way_m += (robot.poses[k].translation() - robot.poses[k - 1].translation()).norm();
  return 2 * range_m * (way_m + 2 * range_m);
}

/// Of the prediction in the plane.
double possible_area_m2(const UncertainPose<SE3>& T) {
  const Eigen::Matrix2d covariance = T.position_covariance().topLeftCorner<2, 2>();
  return 2 * std::numbers::pi * std::sqrt(std::max(0.0, covariance.determinant()));
}

}  // namespace

double LoopVerification::Setting::sigma_up_m() const {
  return std::sqrt(std::max(0.0, up.dot(expected.T_i_j.position_covariance() * up)));
}

double LoopVerification::reach_m(double median_range_m) const {
  return std::max(of_.target_m, median_range_m / 2);
}

bool LoopVerification::reaches_elsewhere(const ExpectedPlace& expected, double median_range_m) const {
  const double reach = reach_m(median_range_m);
  return expected.anywhere || kPossibleSigmas * sigma_in_plane(expected.T_i_j) > reach ||
         std::any_of(expected.alternatives.begin(), expected.alternatives.end(), [&](const auto& other) {
           return (other.T_i_j.translation() - expected.T_i_j.pose.translation()).norm() > reach;
         });
}

ScanLoop LoopVerification::verify(const PlacedKeyframes& target, std::size_t i, const PlacedKeyframes& source,
                                  std::size_t j, const ExpectedPlace& expected) const {
  const auto of_source = source_around(source, j);
  const ScanPyramid& scan = *of_source;
  UncertainPose<SE3> where = expected.T_i_j;
  if (!expected.anywhere) where.covariance *= kBeyond * kBeyond;
  std::vector<Fit> fits = fits_around(target, i, scan, where);
  const auto loop_of = [&](const Fit& fit, LoopStatus status) {
    ScanLoop loop{i, j, fit.T_i_j, bounded(fit.registration.information), fit.registration.inlier_ratio};
    loop.status = status;
    return loop;
  };
  const double nominal_ratio =
      std::min(target.keyframes.nominal_inlier_ratio, source.keyframes.nominal_inlier_ratio);
  if (fits.front().registration.inlier_ratio < params_.min_fit_ratio * nominal_ratio)
    return loop_of(fits.front(), LoopStatus::kLowOverlap);
  if (target.keyframes.kind == ScannerKind::kSpatial && structure_of(scan) < params_.min_structure)
    return loop_of(fits.front(), LoopStatus::kTooLittleStructure);
  const double range_m = std::max(scan.median_range_m, kSamePlace_m);
  const double map_area_m2 = seen_area_m2(target, range_m);
  const Setting setting{
      expected, target.poses[i].rotation_matrix().transpose() * Eigen::Vector3d::UnitZ(),
      of_.storeys == Storeys::kSeveral ? storey_height_m(scan) : std::nullopt, map_area_m2,
      expected.anywhere ? map_area_m2 + seen_area_m2(source, range_m) : possible_area_m2(expected.T_i_j)};
  Alternatives alternatives = weigh(setting, fits);
  for (const OtherPlace& place :
       other_places({target, i, source, j}, setting, scan.median_range_m, fits.front())) {
    if (alternatives.doubt() > params_.max_doubt) break;
    add_fits_at(place, target, i, scan, fits);
    alternatives = weigh(setting, fits);
  }
  if (!fits.front().elsewhere &&
      fits.front().registration.inlier_ratio < params_.min_fit_ratio * nominal_ratio)
    return loop_of(fits.front(), LoopStatus::kLowOverlap);
  const Registration& best = fits.front().registration;
  if (sigma_in_plane({best.T_target_source, covariance_of_fit(best)}) > params_.max_sigma_m)
    return loop_of(fits.front(), LoopStatus::kTooLittleStructure);
  ScanLoop loop = loop_of(fits.front(), status_of(fits.front(), alternatives));
  loop.doubt = alternatives.doubt();
  return loop;
}

ScanLoop LoopVerification::register_near(const PlacedKeyframes& target, std::size_t i,
                                         const PlacedKeyframes& source, std::size_t j,
                                         const UncertainPose<SE3>& T_i_j) const {
  const Fit fit = fits_around(target, i, *source_around(source, j), T_i_j).front();
  return {i, j, fit.T_i_j, bounded(fit.registration.information), fit.registration.inlier_ratio};
}

LoopStatus LoopVerification::status_of(const Fit& best, const Alternatives& alternatives) const {
  if (best.elsewhere || best.likelihood < kFits) return LoopStatus::kAmbiguous;
  if (alternatives.doubt() <= params_.max_doubt) return LoopStatus::kAccepted;
  if (alternatives.fits >= alternatives.unmapped + alternatives.storeys) return LoopStatus::kAmbiguous;
  return alternatives.storeys > alternatives.unmapped ? LoopStatus::kAnotherStorey : LoopStatus::kUnmapped;
}

std::vector<LoopVerification::Fit> LoopVerification::fits_around(const PlacedKeyframes& target, std::size_t i,
                                                                 const ScanPyramid& scan,
                                                                 const UncertainPose<SE3>& where) const {
  const auto kept = target.submaps->around(i, [&] { return Submap(map_around(target, i, of_.target_m)); });
  const Submap& submap = *kept;
  const ScannerKind kind = target.keyframes.kind;
  std::vector<Fit> fits;
  for (const Registration& found : search_pose(submap, scan, where, kind, search_, registration_).fits) {
    Fit& fit = fits.emplace_back(Fit{found, found.T_target_source});
    fit.structure = structure_fit(submap.fine(), scan, found.T_target_source, kind, registration_.loss_scale);
  }
  return fits;
}

std::vector<OtherPlace> LoopVerification::other_places(const ComparedKeyframes& compared,
                                                       const Setting& setting, double median_range_m,
                                                       const Fit& best) const {
  const ExpectedPlace& expected = setting.expected;
  const double reach = reach_m(median_range_m);
  std::vector<OtherPlace> places;
  if (!compared.target.sigma_m) return places;
  places = places_expected(compared, expected, reach, params_.max_doubt);
  if (compared.target.index && compared.source.index && reaches_elsewhere(expected, median_range_m)) {
    const auto alike = places_alike(compared, reach, 2 * of_.target_m, places);
    places.insert(places.end(), alike.begin(), alike.end());
  }
  if (setting.storey_m && (expected.anywhere || kPossibleSigmas * setting.sigma_up_m() > *setting.storey_m)) {
    const auto storeys = places_on_other_storeys(compared, best.T_i_j, *setting.storey_m, reach);
    places.insert(places.end(), storeys.begin(), storeys.end());
  }
  return places;
}

void LoopVerification::add_fits_at(const OtherPlace& place, const PlacedKeyframes& target, std::size_t i,
                                   const ScanPyramid& scan, std::vector<Fit>& fits) const {
  const SE3 T_i_place = target.poses[i].inverse() * target.poses[place.keyframe];
  const double sigma_m = target.sigma_m(i, place.keyframe);
  const double same_m = std::clamp(2 * sigma_m, kSamePlace_m, of_.target_m);
  for (Fit& fit : fits_around(target, place.keyframe, scan, place.T_keyframe_scan)) {
    fit.T_i_j = T_i_place * fit.T_i_j;
    fit.elsewhere = true;
    fit.place_sigma_m = sigma_m;
    const auto is_same = [&](const Fit& other) {
      return (other.T_i_j.translation() - fit.T_i_j.translation()).norm() < same_m;
    };
    if (std::none_of(fits.begin(), fits.end(), is_same)) fits.push_back(fit);
  }
}

LoopVerification::Alternatives LoopVerification::weigh(const Setting& setting, std::vector<Fit>& fits) const {
  const ExpectedPlace& expected = setting.expected;
  double best = 0;
  for (const Fit& fit : fits) best = std::max(best, fit.structure);
  for (Fit& fit : fits) {
    fit.likelihood = likelihood_beside(best, fit.structure, params_.alternative_ratio);
    const SE3::Jacobian covariance = expected.T_i_j.covariance + covariance_of_fit(fit.registration) +
                                     isotropic(fit.place_sigma_m * fit.place_sigma_m, 0);
    double prior = expected.anywhere ? 1 : 0;
    if (!expected.anywhere)
      expected.for_each([&](const SE3& T_i_j, double share) {
        const SE3::Tangent off = (T_i_j.inverse() * fit.T_i_j).log();
        prior += share * prior_density(std::max(0.0, off.dot(ldlt_solve(covariance, off))));
      });
    fit.weight = fit.likelihood * prior;
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.weight > b.weight; });
  return alternatives_of(fits, setting);
}

LoopVerification::Alternatives LoopVerification::alternatives_of(const std::vector<Fit>& weighed,
                                                                 const Setting& setting) const {
  const Fit& best = weighed.front();
  const double weight = std::max(best.weight, kLeastWeight);
  Alternatives alternatives;
  double fitting = kUnseenFits;
  for (std::size_t k = 1; k < weighed.size(); ++k) {
    alternatives.fits += weighed[k].weight / weight;
    if (weighed[k].likelihood > kFits) fitting += weighed[k].likelihood;
  }
  alternatives.unmapped = weight_of_unseen(fitting, setting.map_area_m2, setting.possible_m2) / weight;
  alternatives.storeys = unseen_storeys(setting, best);
  return alternatives;
}

double LoopVerification::unseen_storeys(const Setting& setting, const Fit& fit) const {
  if (!setting.storey_m) return 0;
  const ExpectedPlace& expected = setting.expected;
  if (expected.anywhere) return kStoreyPrior * kUnseenShare / std::max(fit.weight, kLeastWeight);
  std::vector<ExpectedHeight> heights;
  expected.for_each([&](const SE3& T_i_j, double share) {
    heights.push_back({setting.up.dot(T_i_j.translation()), share});
  });
  return kStoreyPrior * other_storeys(*setting.storey_m, setting.up.dot(fit.T_i_j.translation()), heights,
                                      std::max(setting.sigma_up_m(), params_.min_sigma_m));
}

std::shared_ptr<const ScanPyramid> LoopVerification::source_around(const PlacedKeyframes& robot,
                                                                   std::size_t j) const {
  if (of_.source_m == 0) return robot.keyframes.clouds[j].read();
  return std::make_shared<const ScanPyramid>(scan_pyramid(map_around(robot, j, of_.source_m).fine().surfels(),
                                                          robot.keyframes.spacing_m, robot.keyframes.kind,
                                                          map_params_));
}

LocalMap LoopVerification::map_around(const PlacedKeyframes& robot, std::size_t i, double extent_m) const {
  LocalMap map(robot.keyframes.spacing_m, map_params_);
  const SE3 T_i_frame = robot.poses[i].inverse();
  std::optional<double> last_m;
  for (std::size_t k = 0; k < robot.poses.size(); ++k) {
    if (std::abs(robot.path_m[k] - robot.path_m[i]) > extent_m) continue;
    if (k != i && last_m && robot.path_m[k] - *last_m < of_.apart_m) continue;
    map.add(*robot.keyframes.clouds[k].read(), T_i_frame * robot.poses[k], 0);
    last_m = robot.path_m[k];
  }
  return map;
}

SE3::Jacobian LoopVerification::bounded(const SE3::Jacobian& information) const {
  SE3::Tangent most;
  most.head<3>().setConstant(1 / (params_.min_sigma_m * params_.min_sigma_m));
  most.tail<3>().setConstant(1 / (params_.min_sigma_rad * params_.min_sigma_rad));
  const SE3::Jacobian limit = most.asDiagonal();
  const SE3::Jacobian bounded = limit - limit * ldlt_solve_matrix<SE3::Jacobian>(information + limit, limit);
  return 0.5 * (bounded + bounded.transpose());
}

}  // namespace radioslam
