#include "radioslam/lidar/lidar_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/lidar/structure_fit.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinPoints = 20;
constexpr double kElsewhere = 22.46;  // squared deviation from the prior: one in a thousand of those right
constexpr double kAsWell = 0.95;      // of structure that fits

/// Information about the pose of a map's only scan.
SE3::Jacobian tight_information() {
  constexpr double kExact_m = 1e-4, kExact_rad = 1e-5;
  return isotropic(1 / (kExact_m * kExact_m), 1 / (kExact_rad * kExact_rad));
}

/// Of the step to a scan from that at `last`. The errors of both ends count once for each metre or ten
/// degrees that the robot moves: more scans on the same map do not add any.
SE3::Jacobian step_covariance(const Registration& fit, const PosePrior& prior, const SE3& last) {
  constexpr double kApart_m = 0.5, kApart_rad = 0.087, kLeast = 0.25;
  const SE3::Tangent moved = (last.inverse() * fit.T_target_source).log();
  const double apart = std::max(moved.head<3>().norm() / kApart_m, moved.tail<3>().norm() / kApart_rad);
  const SE3::Jacobian noise = std::clamp(apart, kLeast, 1.0) * fit.noise + prior.information;
  return congruence(inverse(fit.posterior), noise);
}

void describe(const Registration& fit, ScanPose& result) {
  result.inlier_ratio = fit.inlier_ratio;
  result.normalised_rms = fit.normalised_rms;
  result.iterations = fit.iterations;
}

}  // namespace

bool ScanGapDetector::is_after_gap(Stamp stamp) {
  const double dt_s = newest_ ? seconds_between(*newest_, stamp) : 0;
  newest_ = stamp;
  if (dt_s <= 0) return false;
  const double max_s = interval_s_ > 0 ? params_.max_lost_scans * interval_s_ : dt_s;
  const double newest_ratio = interval_s_ > 0 ? params_.error_smoothing : 1;
  interval_s_ += newest_ratio * (std::min(dt_s, max_s) - interval_s_);
  return dt_s > max_s;
}

Trajectory<SE3> trajectory_of(const ScanPoses& scans) {
  std::vector<StampedPose<SE3>> poses;
  for (const ScanPose& scan : scans) poses.push_back({scan.stamp, scan.T_start_body});
  return Trajectory<SE3>(std::move(poses));
}

LidarOdometry::LidarOdometry(const ScannerTraits& traits, const LidarParams& params)
    : matcher_(traits, params),
      map_(matcher_.empty_map()),
      error_(params.odometry),
      structure_(traits.kind, params.order, params.odometry.max_lost_scans),
      gaps_(params.odometry) {}

ScanPose LidarOdometry::register_scan(Stamp stamp, const LidarScan& scan,
                                      const std::optional<SE3>& T_previous_body, MotionSource given_by,
                                      const SE3::Jacobian& motion_covariance) {
  const MotionSource source = T_previous_body ? given_by : MotionSource::kConstantVelocity;
  const Prediction predicted = predict(stamp, T_previous_body);
  const ScanPoints points = filter_and_deskew(scan, predicted.twist_per_s, matcher_.params().points);
  ScanPose result{.stamp = stamp, .T_start_body = predicted.T_map_body, .counts = points.counts};
  if (points.points.size() < kMinPoints) return result;

  const bool is_after_gap = gaps_.is_after_gap(stamp) && last_;
  if (is_after_gap && !T_previous_body) result.T_start_body = last_->T_map_body;
  DeskewedScan deskewed = matcher_.measure(stamp, points, predicted.twist_per_s, source);
  result.cloud = matcher_.pyramid_of(deskewed);
  result.status = ScanStatus::kLost;
  if (!last_) {
    if (structure_.admits(result.cloud.all)) start_map(deskewed, result);
    return result;
  }

  const PosePrior prior = error_.prior_at(result.T_start_body);
  Registration fit = register_at_prediction(result.cloud, prior);
  const bool fits = fit.inlier_ratio >= error_.relocalise_below_ratio();
  const bool is_lost = !fits && structure_.admits(result.cloud.all);
  std::optional<UncertainPose<SE3>> motion;
  if (T_previous_body && !motion_covariance.isZero()) motion = {*T_previous_body, motion_covariance};
  if (is_after_gap &&
      (motion_in_gap_m(stamp, motion) > map_.coarse().max_distance_m() || (is_lost && !motion))) {
    start_map_after_gap(deskewed, motion, result);
    return result;
  }
  const bool is_spatial = matcher_.traits().kind == ScannerKind::kSpatial;
  const bool is_stuck = is_spatial && fits && fit.end == RegistrationStatus::kMaxIterations;
  if (is_lost || is_stuck) fit = relocalised(result.cloud, prior, fit, T_previous_body.has_value());
  describe(fit, result);
  if ((fits || is_lost || error_.is_known()) && fit.inlier_ratio >= error_.min_inlier_ratio())
    add_to_map({std::move(deskewed), std::move(result.cloud), fit}, prior, result);
  else if (is_lost)
    add_to_candidate(deskewed, result);
  return result;
}

LidarOdometry::Prediction LidarOdometry::predict(Stamp stamp,
                                                 const std::optional<SE3>& T_previous_body) const {
  const double dt_s = last_ ? seconds_between(last_->stamp, stamp) : 0;
  SE3 motion = T_previous_body ? *T_previous_body : SE3::exp(dt_s * twist_per_s_);
  if (matcher_.traits().kind == ScannerKind::kPlanar) motion = lift(flatten(motion));  // its map is planar
  return {last_ ? last_->T_map_body * motion : motion,
          T_previous_body && dt_s > 0 ? SE3::Tangent(motion.log() / dt_s) : twist_per_s_};
}

Registration LidarOdometry::register_at_prediction(const ScanPyramid& cloud, const PosePrior& prior) const {
  return matcher_.register_near(map_, cloud, prior, error_.sigma_at_range_m(cloud.median_range_m),
                                error_.is_known() ? error_.min_inlier_ratio() : 0);
}

/// Where the motion is poorly constrained, the previous pose fits better because each beam hits its own
/// earlier scan line, on the ground most of all. The scan's structure must not fit worse there; and far from
/// where a measured motion leads, the fit must be as good as others were. A registration that has not ended
/// is where its iterations left it, and any better one replaces it.
Registration LidarOdometry::relocalised(const ScanPyramid& cloud, const PosePrior& prior,
                                        const Registration& near, bool is_measured) const {
  const LidarParams& params = matcher_.params();
  const bool has_ended =
      matcher_.traits().kind == ScannerKind::kPlanar || near.end != RegistrationStatus::kMaxIterations;
  const double better = near.inlier_ratio / (has_ended ? params.odometry.relocalise_below_ratio : 1);
  const Registration far =
      relocalise(map_, cloud,
                 {last_->T_map_body, prior.pose, static_cast<std::size_t>(params.odometry.max_aligned),
                  std::max(error_.relocalise_below_ratio(), better)},
                 matcher_.traits().kind, params.registration);
  if (far.inlier_ratio <= better) return near;
  const SE3::Tangent off = (prior.pose.inverse() * far.T_target_source).log();
  const bool is_elsewhere = off.dot(prior.information * off) > kElsewhere;
  if (is_measured && is_elsewhere && error_.is_known() && far.inlier_ratio < error_.relocalise_below_ratio())
    return near;
  const SurfelColumns surfels(map_.fine().surfels(), map_.fine().max_distance_m());
  const auto structure = [&](const Registration& fit) {
    return structure_fit(surfels, cloud, fit.T_target_source, matcher_.traits().kind,
                         params.registration.loss_scale);
  };
  return structure(far) >= kAsWell * structure(near) ? far : near;
}

void LidarOdometry::start_map(const DeskewedScan& scan, ScanPose& result) {
  start_ = scan.stamp;
  result.status = ScanStatus::kMapStart;
  result.information = matcher_.observable_information(tight_information());
  advance(scan.on_map(result.T_start_body));
  result.novelty_ratio = map_.add(result.cloud, result.T_start_body, travelled_m_);
  first_ = scan;
}

void LidarOdometry::start_map_after_gap(const DeskewedScan& scan,
                                        const std::optional<UncertainPose<SE3>>& motion, ScanPose& result) {
  if (motion) {
    result.covariance = motion->covariance;
  } else {
    const double wide_m = matcher_.params().odometry.first_sigma_m + motion_in_gap_m(scan.stamp, motion);
    result.covariance = isotropic(wide_m * wide_m, std::numbers::pi * std::numbers::pi);
  }
  result.status = ScanStatus::kNewMap;
  result.information = matcher_.observable_information(tight_information());
  map_ = matcher_.empty_map();
  candidate_.reset();
  last_ = scan.on_map(result.T_start_body);
  twist_per_s_.setZero();
  error_.forget();
  result.novelty_ratio = map_.add(result.cloud, result.T_start_body, travelled_m_);
  first_ = scan;
}

double LidarOdometry::motion_in_gap_m(Stamp stamp, const std::optional<UncertainPose<SE3>>& measured) const {
  constexpr double kSigmas = 3, kLeastSpeed = 0.1;
  if (measured) return kSigmas * std::sqrt(measured->covariance.diagonal().head<3>().maxCoeff());
  const double tracked_s = seconds_between(*start_, last_->stamp);
  const double mean_speed = tracked_s > 0 ? travelled_m_ / tracked_s : 0;
  return seconds_between(last_->stamp, stamp) *
         std::max({kLeastSpeed, mean_speed, twist_per_s_.head<3>().norm()});
}

void LidarOdometry::add_to_map(MatchedScan matched, const PosePrior& prior, ScanPose& result) {
  candidate_.reset();
  structure_.reset();
  const SE3 prediction_error = prior.pose.inverse() * matched.fit.T_target_source;
  if (auto start =
          first_ ? deskew_map_start(*first_, *last_, matched, prior, travelled_m_, matcher_) : std::nullopt) {
    map_ = std::move(start->map);
    last_ = start->first;
    matched = std::move(start->next);
    result.first_cloud = std::move(start->first_cloud);
  }
  first_.reset();
  matched = deskew_and_match(std::move(matched), map_, *last_, prior, matcher_);
  describe(matched.fit, result);
  result.status = ScanStatus::kRegistered;
  result.T_start_body = matched.fit.T_target_source;
  result.covariance = matcher_.traits().kind == ScannerKind::kPlanar
                          ? inverse(matched.fit.posterior)
                          : step_covariance(matched.fit, prior, last_->T_map_body);
  result.information = matcher_.observable_information(matched.fit.information);
  result.cloud = std::move(matched.cloud);
  error_.update(prediction_error, result.inlier_ratio);
  advance(matched.scan.on_map(result.T_start_body));
  if (result.inlier_ratio >= matcher_.params().odometry.min_insert_ratio * error_.nominal_inlier_ratio())
    result.novelty_ratio = map_.add(result.cloud, result.T_start_body, travelled_m_);
}

void LidarOdometry::add_to_candidate(const DeskewedScan& scan, ScanPose& result) {
  const SE3 predicted = result.T_start_body;
  const auto on_candidate =
      candidate_ ? candidate_->add(scan, result.cloud, predicted, error_, travelled_m_, matcher_)
                 : std::nullopt;
  const int max_lost_scans = error_.is_known() ? matcher_.params().odometry.max_lost_scans : 1;
  if (!on_candidate)
    candidate_.emplace(scan, result.cloud, predicted, last_->T_map_body, travelled_m_, matcher_);
  else if (candidate_->scans() > max_lost_scans)
    promote_candidate(*on_candidate, result);
}

void LidarOdometry::promote_candidate(const CandidateMap::Fit& on_candidate, ScanPose& result) {
  const Registration& fit = on_candidate.fit;
  result.status = ScanStatus::kNewMap;
  result.novelty_ratio = on_candidate.novelty_ratio;
  result.information = matcher_.observable_information(fit.information);
  result.inlier_ratio = fit.inlier_ratio;
  result.T_start_body = fit.T_target_source;
  result.covariance = candidate_->step_covariance(matcher_.params().odometry);
  error_.update(on_candidate.prior.pose.inverse() * fit.T_target_source, fit.inlier_ratio);
  last_ = candidate_->before_last();
  advance(candidate_->last());
  map_ = std::move(*candidate_).take_map();
  candidate_.reset();
  first_.reset();
}

void LidarOdometry::advance(const ScanOnMap& place) {
  if (last_) {
    if (last_->middle_stamp < place.middle_stamp) twist_per_s_ = twist_between(*last_, place);
    travelled_m_ += (last_->T_map_body.inverse() * place.T_map_body).translation().norm();
  }
  last_ = place;
}

}  // namespace radioslam
