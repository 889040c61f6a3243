#include "radioslam/lidar/scan_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/median.hpp"
#include "radioslam/lidar/voxel_grid.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kFewestPoints = 20;
constexpr std::size_t kTraitScans = 10;
constexpr float kFlat_m = 1e-3F;

double square(double x) { return x * x; }

}  // namespace

ScannerTraits scanner_traits(const LidarLog& log, const LidarParams& params) {
  std::vector<double> ranges;
  ScannerTraits traits;
  traits.kind = ScannerKind::kPlanar;
  const std::size_t stride = std::max<std::size_t>(1, log.size() / kTraitScans);
  for (std::size_t k = 0; k < log.size(); k += stride) {
    const auto points = usable_points(log.read(k), SE3::Tangent::Zero(), params.points).points;
    for (const Eigen::Vector3f& point : points) {
      ranges.push_back(static_cast<double>(point.norm()));
      if (std::abs(point.z() - points.front().z()) > kFlat_m) traits.kind = ScannerKind::kSpatial;
    }
  }
  const ScanOdometryParams& odometry = params.odometry;
  traits.spacing_m = odometry.spacing_m > 0 ? odometry.spacing_m
                     : ranges.empty()       ? odometry.most_spacing_m
                                            : std::clamp(odometry.spacing_share * upper_median(ranges),
                                                         odometry.least_spacing_m, odometry.most_spacing_m);
  return traits;
}

ScanOdometer::ScanOdometer(const ScannerTraits& traits, const LidarParams& params)
    : traits_(traits),
      params_(params),
      map_(traits.spacing_m, params.odometry.reach_spacings * traits.spacing_m),
      coarse_map_(params.odometry.coarse_spacings * traits.spacing_m,
                  params.odometry.coarse_reach_spacings * traits.spacing_m) {}

double ScanOdometer::sigma_m() const {
  const auto& p = params_.odometry;
  return deviation_.count == 0 ? p.first_sigma_m
                               : std::max(p.least_sigma_m, std::sqrt(deviation_.squares_m2));
}

double ScanOdometer::sigma_rad() const {
  const auto& p = params_.odometry;
  return deviation_.count == 0 ? p.first_sigma_rad
                               : std::max(p.least_sigma_rad, std::sqrt(deviation_.squares_rad2));
}

PosePrior ScanOdometer::prior_at(const SE3& predicted) const {
  PosePrior prior{predicted};
  prior.information.diagonal().head<3>().setConstant(1 / square(sigma_m()));
  prior.information.diagonal().tail<3>().setConstant(1 / square(sigma_rad()));
  return prior;
}

std::vector<Surfel> ScanOdometer::thinned(const std::vector<Surfel>& surfels, double spacings) const {
  return first_per_voxel(surfels, spacings * traits_.spacing_m);
}

Registration ScanOdometer::register_scan(const std::vector<Surfel>& surfels, const PosePrior& prior) const {
  const auto fine = [&](const Eigen::Vector3f& point, float squared) { return map_.nearest(point, squared); };
  const auto coarse = [&](const Eigen::Vector3f& point, float squared) {
    return coarse_map_.nearest(point, squared);
  };
  const double deviation = sigma_m() + sigma_rad() * median_range_m_;
  const double wanted = params_.odometry.reach_sigmas * deviation;
  const double reach = std::clamp(wanted, traits_.spacing_m, map_.reach_m());
  const auto source = thinned(surfels, params_.odometry.source_spacings);
  Registration best = register_surfels(fine, source, {prior.pose, std::min(deviation, reach), reach}, prior, traits_.kind,
                            params_.registration);
  const double expected = params_.odometry.enough * usual_matched_share_;
  if (best.matched_share >= expected) return best;
  RegistrationParams rough = params_.registration;
  rough.translation_tolerance_m = 0.1 * traits_.spacing_m;
  rough.rotation_tolerance_rad = 0.01;
  PosePrior none{prior.pose};
  none.information.diagonal().setConstant(1e-3);
  const auto few = thinned(surfels, params_.odometry.coarse_spacings);
  const SE3::Tangent ahead = (pose_.inverse() * prior.pose).log();
  for (const double share : {1.0, 0.0, 0.5})
    for (const double turn : {0.0, -0.25, 0.25, -0.5, 0.5}) {
      const SE3 guess = pose_ * SE3::exp(share * ahead) * SE3({0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())));
      const Registration start =
          register_surfels(coarse, few, {guess, 0.5 * coarse_map_.reach_m(), coarse_map_.reach_m()}, none,
                           traits_.kind, rough);
      const Registration fit = register_surfels(
          fine, source, {start.T_target_source, traits_.spacing_m, map_.reach_m()}, none, traits_.kind,
          params_.registration);
      if (fit.matched_share > best.matched_share) best = fit;
      if (best.matched_share >= expected) return best;
    }
  return best;
}

ScanPose ScanOdometer::add(Stamp stamp, const LidarScan& scan, const std::optional<SE3>& T_previous_body) {
  const double dt_s = last_ ? seconds_between(*last_, stamp) : 0;
  const SE3 motion = T_previous_body ? *T_previous_body : SE3::exp(dt_s * twist_per_s_);
  const SE3::Tangent twist = T_previous_body && dt_s > 0 ? SE3::Tangent(motion.log() / dt_s) : twist_per_s_;
  ScanPoints usable = usable_points(scan, twist, params_.points);

  ScanPose result;
  result.stamp = stamp;
  result.T_start_body = pose_ * motion;
  result.counts = usable.counts;
  if (usable.points.size() < kFewestPoints) return result;
  const auto surfels = measure_surfels(thin_by_voxels(usable.points, traits_.spacing_m), traits_.spacing_m,
                                       traits_.kind, params_.surfel);
  std::vector<double> ranges;
  for (const Surfel& surfel : surfels) ranges.push_back(static_cast<double>(surfel.position.norm()));
  median_range_m_ = upper_median(ranges);
  if (map_.empty()) {
    result.outcome = ScanOutcome::kFirst;
  } else {
    const PosePrior prior = prior_at(result.T_start_body);
    const Registration fit = register_scan(surfels, prior);
    result.matched_share = fit.matched_share;
    result.rms_m = fit.rms_m;
    result.iterations = fit.iterations;
    if (fit.end == RegistrationEnd::kNoOverlap || fit.matched_share < params_.odometry.least_matched_share) {
      result.outcome = ScanOutcome::kUnmatched;
      return result;
    }
    const SE3 deviation = prior.pose.inverse() * fit.T_target_source;
    const auto n = static_cast<double>(++deviation_.count);
    const double share = std::max(1 / n, 0.05);
    deviation_.squares_m2 += share * (deviation.translation().squaredNorm() / 3 - deviation_.squares_m2);
    deviation_.squares_rad2 += share * (deviation.log().tail<3>().squaredNorm() / 3 - deviation_.squares_rad2);
    result.T_start_body = fit.T_target_source;
    result.covariance = fit.posterior.inverse();
    result.outcome = ScanOutcome::kRegistered;
  }
  const bool fits = result.outcome == ScanOutcome::kFirst ||
                    result.matched_share >= params_.odometry.insert_share * usual_matched_share_;
  if (result.outcome == ScanOutcome::kRegistered)
    usual_matched_share_ += (usual_matched_share_ == 0 ? 1 : 0.1) * (result.matched_share - usual_matched_share_);
  if (dt_s > 0) twist_per_s_ = (pose_.inverse() * result.T_start_body).log() / dt_s;
  pose_ = result.T_start_body;
  last_ = stamp;
  if (!fits) return result;
  std::vector<Surfel> moved(surfels.size());
  const Eigen::Matrix3f R = pose_.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = pose_.translation().cast<float>();
  for (std::size_t k = 0; k < surfels.size(); ++k)
    moved[k] = {R * surfels[k].position + t, R * surfels[k].covariance * R.transpose()};
  map_.add(moved);
  coarse_map_.add(moved);
  map_.forget_beyond(t, params_.odometry.map_radius_m);
  coarse_map_.forget_beyond(t, params_.odometry.map_radius_m);
  return result;
}

}  // namespace radioslam
