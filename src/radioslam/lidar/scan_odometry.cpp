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

/// Where a robot may be that moved otherwise than predicted: it stopped, or turned up to four steps further.
std::vector<SE3> starts_about(const SE3& last, const SE3& predicted, double step_m, double range_m) {
  const double step_rad = step_m / std::max(range_m, step_m);
  std::vector<SE3> starts;
  for (const SE3& guess : {predicted, last, interpolate(last, predicted, 0.5)})
    for (const double steps : {0.0, -0.5, 0.5, -1.0, 1.0, -2.0, 2.0}) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(steps * step_rad, Eigen::Vector3d::UnitZ()));
      starts.push_back(guess * SE3(Eigen::Vector3d::Zero(), turn));
    }
  return starts;
}

}  // namespace

ScannerTraits scanner_traits(const LidarLog& log, const LidarParams& params) {
  std::vector<double> ranges;
  ScannerTraits traits;
  traits.kind = ScannerKind::kPlanar;
  const std::size_t stride = std::max<std::size_t>(1, (log.size() + kTraitScans - 1) / kTraitScans);
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
    : traits_(traits), params_(params), map_(traits.spacing_m, params.map) {}

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

double ScanOdometer::least_share() const {
  const auto& p = params_.odometry;
  const double usual = left_out_ < p.patience ? usual_share_ : 0;  // else it may be the map that is wrong
  return std::max(p.least_matched_share, p.least_usual_share * usual);
}

PosePrior ScanOdometer::prior_at(const SE3& predicted) const {
  PosePrior prior{predicted};
  prior.information.diagonal().head<3>().setConstant(1 / square(params_.odometry.prior_factor * sigma_m()));
  prior.information.diagonal().tail<3>().setConstant(1 / square(params_.odometry.prior_factor * sigma_rad()));
  return prior;
}

Registration ScanOdometer::lay_onto_map(const ScanCloud& cloud, const PosePrior& prior) const {
  const double deviation_m = sigma_m() + sigma_rad() * cloud.median_range_m;
  Registration near = register_near(map_, cloud, prior, deviation_m, traits_.kind, params_.registration);
  const double enough = deviation_.count == 0 ? 1 : params_.odometry.enough_share * usual_share_;
  if (near.matched_share >= enough) return near;
  const auto starts = starts_about(pose_, prior.pose, map_.coarse().reach_m() / 2, cloud.median_range_m);
  const Registration far = register_from(map_, cloud, starts, enough, traits_.kind, params_.registration);
  return far.matched_share > near.matched_share ? far : near;
}

void ScanOdometer::learn(const SE3& deviation, double matched_share) {
  const double newest =
      std::max(1 / static_cast<double>(++deviation_.count), params_.odometry.deviation_share);
  const auto towards = [&](double& mean, double squares) { mean += newest * (squares / 3 - mean); };
  towards(deviation_.squares_m2, deviation.translation().squaredNorm());
  towards(deviation_.squares_rad2, deviation.log().tail<3>().squaredNorm());
  usual_share_ += newest * (matched_share - usual_share_);
}

void ScanOdometer::advance(const ScanPose& scan, const SweepMiddle& middle) {
  const SE3 T_start_middle = scan.T_start_body * middle.T_body_middle;
  const double dt_s = seconds_between(middle_stamp_, middle.stamp);
  if (last_ && dt_s > 0) twist_per_s_ = (middle_.inverse() * T_start_middle).log() / dt_s;
  way_m_ += (pose_.inverse() * scan.T_start_body).translation().norm();
  pose_ = scan.T_start_body;
  middle_ = T_start_middle;
  middle_stamp_ = middle.stamp;
  last_ = scan.stamp;
  if (scan.matched_share >= params_.odometry.insert_share * usual_share_) map_.add(scan.cloud, pose_, way_m_);
}

ScanPose ScanOdometer::add(Stamp stamp, const LidarScan& scan, const std::optional<SE3>& T_previous_body) {
  const double dt_s = last_ ? seconds_between(*last_, stamp) : 0;
  const SE3 motion = T_previous_body ? *T_previous_body : SE3::exp(dt_s * twist_per_s_);
  const SE3::Tangent twist = T_previous_body && dt_s > 0 ? SE3::Tangent(motion.log() / dt_s) : twist_per_s_;
  const ScanPoints usable = usable_points(scan, twist, params_.points);
  const SweepMiddle middle{{stamp.ns + Stamp::from_seconds(usable.middle_s).ns},
                           SE3::exp(usable.middle_s * twist)};

  ScanPose result;
  result.stamp = stamp;
  result.T_start_body = pose_ * motion;
  result.counts = usable.counts;
  if (usable.points.size() < kFewestPoints) return result;
  result.cloud = scan_cloud(measure_surfels(thin_by_voxels(usable.points, traits_.spacing_m),
                                            traits_.spacing_m, traits_.kind, params_.surfel),
                            traits_.spacing_m, traits_.kind, params_.map);
  if (map_.empty()) {
    result.outcome = ScanOutcome::kFirst;
    advance(result, middle);
    return result;
  }
  const PosePrior prior = prior_at(result.T_start_body);
  const Registration fit = lay_onto_map(result.cloud, prior);
  result.matched_share = fit.matched_share;
  result.rms_m = fit.rms_m;
  result.iterations = fit.iterations;
  result.outcome = ScanOutcome::kUnmatched;
  if (fit.matched_share < least_share()) return ++left_out_, result;
  left_out_ = 0;
  result.outcome = ScanOutcome::kRegistered;
  result.T_start_body = fit.T_target_source;
  result.covariance = fit.posterior.inverse();
  result.information = fit.information;
  learn(prior.pose.inverse() * fit.T_target_source, fit.matched_share);
  advance(result, middle);
  return result;
}

}  // namespace radioslam
