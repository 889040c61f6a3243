#include "radioslam/lidar/scan_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/lidar/voxel_grid.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kFewestPoints = 20;

double square(double x) { return x * x; }

/// Of where a scan lies on the map that it alone makes up.
SE3::Jacobian exact() {
  constexpr double kExact_m = 1e-4, kExact_rad = 1e-5;
  return isotropic(1 / square(kExact_m), 1 / square(kExact_rad));
}

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

Trajectory<SE3> trajectory_of(const std::vector<ScanPose>& scans) {
  std::vector<StampedPose<SE3>> poses;
  for (const ScanPose& scan : scans) poses.push_back({scan.stamp, scan.T_start_body});
  return Trajectory<SE3>(std::move(poses));
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
  return deviation_.count == 0 ? p.least_first_share
                               : std::max(p.least_matched_share, p.least_usual_share * usual_share_);
}

double ScanOdometer::enough_share() const {
  return deviation_.count == 0 ? 1 : std::max(least_share(), params_.odometry.enough_share * usual_share_);
}

/// Where nothing has any order for long, that is how the world looks.
bool ScanOdometer::may_be_a_map(const ScanCloud& cloud) {
  if (scan_order(cloud.all, traits_.kind, params_.order) >= params_.order.least_share)
    without_order_ = 0;
  else
    without_order_ = std::min(without_order_ + 1, params_.odometry.patience + 1);
  return without_order_ == 0 || without_order_ > params_.odometry.patience;
}

/// Is the last scan much longer ago than usual?
bool ScanOdometer::is_after_gap(Stamp stamp) {
  const double dt_s = newest_ ? seconds_between(*newest_, stamp) : 0;
  newest_ = stamp;
  if (dt_s <= 0) return false;
  const double most_s = interval_s_ > 0 ? params_.odometry.patience * interval_s_ : dt_s;
  const double newest_share = interval_s_ > 0 ? params_.odometry.deviation_share : 1;
  interval_s_ += newest_share * (std::min(dt_s, most_s) - interval_s_);
  return dt_s > most_s;
}

/// A scanner in the plane does not see its robot rock, which it does a little.
SE3::Jacobian ScanOdometer::told_of_pose(const SE3::Jacobian& information) const {
  if (traits_.kind == ScannerKind::kSpatial) return information;
  return known_off_plane(information, 1 / square(params_.odometry.level_sigma_m),
                         1 / square(params_.odometry.level_sigma_rad));
}

PosePrior ScanOdometer::prior_at(const SE3& predicted) const {
  const double factor = params_.odometry.prior_factor;
  return {predicted, isotropic(1 / square(factor * sigma_m()), 1 / square(factor * sigma_rad()))};
}

ScanSweep ScanOdometer::sweep_of(Stamp stamp, const ScanPoints& points, const SE3::Tangent& twist_per_s,
                                 MotionSource source) const {
  ThinnedPoints thinned = thin_by_voxels(points.points, points.times_s, traits_.spacing_m);
  return {stamp,
          source,
          twist_per_s,
          measure_surfels(thinned.points, traits_.spacing_m, traits_.kind, params_.surfel),
          std::move(thinned.times_s),
          points.middle_s};
}

ScanCloud ScanOdometer::cloud_of(const ScanSweep& sweep) const {
  return scan_cloud(sweep.surfels, traits_.spacing_m, traits_.kind, params_.map);
}

Registration ScanOdometer::lay_nearby(const ScanCloud& cloud, const PosePrior& prior) const {
  const double deviation_m = sigma_m() + sigma_rad() * cloud.median_range_m;
  return register_near(map_, cloud, prior, deviation_m, traits_.kind, params_.registration,
                       deviation_.count == 0 ? 0 : least_share());
}

/// From other starts, the most promising of them; `near` unless it fits worse by far. Where little tells the
/// motion, scans fit a little better where their beams meet what they drew before: where the robot was.
Registration ScanOdometer::search_afar(const ScanCloud& cloud, const PosePrior& prior,
                                       const Registration& near) const {
  const auto starts =
      starts_about(last_->T_map_body, prior.pose, map_.coarse().reach_m() / 2, cloud.median_range_m);
  const auto promising =
      most_promising(map_, cloud, starts, static_cast<std::size_t>(params_.odometry.most_aligned));
  const double better = near.matched_share / params_.odometry.enough_share;
  const Registration far = register_from(map_, cloud, promising, std::max(enough_share(), better),
                                         traits_.kind, params_.registration);
  return far.matched_share > better ? far : near;
}

/// Puts the motion that was found in the place of that so far, if the scan fits no worse for it.
Registration ScanOdometer::unbend(ScanSweep& sweep, ScanCloud& cloud, const Registration& fit,
                                  const PosePrior& prior) const {
  if (sweep.times_s.empty()) return fit;
  const ScanPlace place = sweep.place_at(fit.T_target_source);
  if (place.middle_stamp <= last_->middle_stamp) return fit;
  ScanSweep unbent = sweep;
  unbent.unbend_by(twist_between(*last_, place));
  ScanCloud unbent_cloud = cloud_of(unbent);
  Registration better = register_at(map_, unbent_cloud, place.T_map_middle * unbent.T_body_middle().inverse(),
                                    prior, 0, traits_.kind, params_.registration);
  if (better.matched_share < params_.odometry.enough_share * fit.matched_share) return fit;
  sweep = std::move(unbent);
  cloud = std::move(unbent_cloud);
  better.iterations += fit.iterations;
  return better;
}

/// Unbends the first two sweeps of a map by the motion from the one to the other, and lays them anew; nothing
/// where they fit worse for it. A bent sweep lies right in its middle.
std::optional<ScanOdometer::MapStart> ScanOdometer::unbend_start(const ScanSweep& first, const ScanPlace& at,
                                                                 const ScanSweep& next,
                                                                 const Registration& fit,
                                                                 const PosePrior& prior) const {
  const double dt_s = seconds_between(at.middle_stamp, next.middle());
  if (first.times_s.empty() || dt_s <= 0) return std::nullopt;
  const SE3::Tangent twist_per_s = next.source == MotionSource::kTold
                                       ? next.twist_per_s
                                       : twist_between(at, next.place_at(fit.T_target_source));
  MapStart start{first, next, LocalMap(traits_.spacing_m, params_.map), {}, {}, {}, {}};
  start.first.unbend_by(twist_per_s);
  start.next.unbend_by(twist_per_s);
  start.first_cloud = cloud_of(start.first);
  start.next_cloud = cloud_of(start.next);
  start.first_place = start.first.place_at(at.T_map_body);
  start.map.add(start.first_cloud, at.T_map_body, way_m_);
  const SE3 predicted = start.first_place.T_map_middle * SE3::exp(dt_s * twist_per_s);
  start.fit = register_at(start.map, start.next_cloud, predicted * start.next.T_body_middle().inverse(),
                          prior, traits_.spacing_m, traits_.kind, params_.registration);
  if (start.fit.matched_share < params_.odometry.enough_share * fit.matched_share) return std::nullopt;
  return start;
}

void ScanOdometer::learn(const SE3& deviation, double matched_share) {
  const double newest =
      std::max(1 / static_cast<double>(++deviation_.count), params_.odometry.deviation_share);
  const auto towards = [&](double& mean, double squares) { mean += newest * (squares / 3 - mean); };
  towards(deviation_.squares_m2, deviation.translation().squaredNorm());
  towards(deviation_.squares_rad2, deviation.log().tail<3>().squaredNorm());
  usual_share_ += newest * (matched_share - usual_share_);
}

void ScanOdometer::advance(const ScanPlace& place) {
  if (last_) {
    if (last_->middle_stamp < place.middle_stamp) twist_per_s_ = twist_between(*last_, place);
    way_m_ += (last_->T_map_body.inverse() * place.T_map_body).translation().norm();
  }
  last_ = place;
}

void ScanOdometer::begin_rival(const ScanSweep& sweep, const ScanCloud& cloud, const SE3& predicted) {
  const SE3 gap = last_->T_map_body.inverse() * predicted;
  rival_ = Rival{LocalMap(traits_.spacing_m, params_.map),
                 sweep.place_at(predicted),
                 sweep.place_at(predicted),
                 predicted,
                 sweep,
                 gap.translation().norm(),
                 gap.log().tail<3>().norm()};
  rival_->map.add(cloud, predicted, way_m_);
}

/// Its first two sweeps, the second of which is this one.
void ScanOdometer::unbend_rival(ScanSweep& sweep, ScanCloud& cloud, Registration& fit,
                                const PosePrior& prior) {
  auto start = unbend_start(rival_->first, rival_->last, sweep, fit, prior);
  if (!start) return;
  rival_->map = std::move(start->map);
  rival_->last = start->first_place;
  sweep = std::move(start->next);
  cloud = std::move(start->next_cloud);
  fit = start->fit;
}

/// Where the scan lies on the rival; the rival takes it, or is begun anew.
std::optional<ScanOdometer::RivalFit> ScanOdometer::lay_onto_rival(ScanSweep sweep, ScanCloud& cloud,
                                                                   const SE3& predicted) {
  if (rival_) {
    const PosePrior prior = prior_at(rival_->last.T_map_body * rival_->predicted.inverse() * predicted);
    Registration fit = register_near(rival_->map, cloud, prior, rival_->map.fine().reach_m(), traits_.kind,
                                     params_.registration);
    if (fit.matched_share >= std::max(params_.odometry.least_first_share, least_share())) {
      if (rival_->scans++ == 1) unbend_rival(sweep, cloud, fit, prior);
      const double new_share = rival_->map.add(cloud, fit.T_target_source, way_m_);
      rival_->before = std::exchange(rival_->last, sweep.place_at(fit.T_target_source));
      rival_->predicted = predicted;
      return RivalFit{fit, prior, new_share};
    }
  }
  begin_rival(sweep, cloud, predicted);
  return std::nullopt;
}

/// The rival is the map from now on. All of the motion from the one to the other may be wrong.
void ScanOdometer::begin_anew(const RivalFit& on_rival, ScanPose& result) {
  result.outcome = ScanOutcome::kNewMap;
  result.new_share = on_rival.new_share;
  result.information = told_of_pose(on_rival.fit.information);
  result.matched_share = on_rival.fit.matched_share;
  result.T_start_body = on_rival.fit.T_target_source;
  const double wide_m = params_.odometry.first_sigma_m + rival_->gap_m;
  const double wide_rad = params_.odometry.first_sigma_rad + rival_->gap_rad;
  result.covariance = isotropic(square(wide_m), square(wide_rad));
  map_ = std::move(rival_->map);
  const ScanPlace place = rival_->last;
  last_ = rival_->before;
  learn(on_rival.prior.pose.inverse() * on_rival.fit.T_target_source, on_rival.fit.matched_share);
  advance(place);
  rival_.reset();
  first_.reset();
}

/// Lays the scan onto what others that fit the map no better make up; enough of them are the map.
void ScanOdometer::try_new_map(const ScanSweep& sweep, ScanPose& result) {
  const auto on_rival = lay_onto_rival(sweep, result.cloud, result.T_start_body);
  const int patience = deviation_.count == 0 ? 1 : params_.odometry.patience;
  if (on_rival && rival_->scans > patience) begin_anew(*on_rival, result);
}

void ScanOdometer::begin(const ScanSweep& sweep, ScanPose& result) {
  result.outcome = ScanOutcome::kFirst;
  result.information = told_of_pose(exact());
  advance(sweep.place_at(result.T_start_body));
  result.new_share = map_.add(result.cloud, result.T_start_body, way_m_);
  first_ = sweep;
}

/// Where the scan before it was, as if the robot had stood; it may have gone on, and turned any way.
void ScanOdometer::begin_after_gap(const ScanSweep& sweep, ScanPose& result) {
  const double gap_s = seconds_between(last_->stamp, sweep.stamp);
  const double wide_m = params_.odometry.first_sigma_m + gap_s * twist_per_s_.head<3>().norm();
  result.outcome = ScanOutcome::kNewMap;
  result.covariance = isotropic(square(wide_m), square(std::numbers::pi));
  result.information = told_of_pose(exact());
  map_ = LocalMap(traits_.spacing_m, params_.map);
  rival_.reset();
  last_ = sweep.place_at(result.T_start_body);
  twist_per_s_.setZero();
  deviation_ = {};
  result.new_share = map_.add(result.cloud, result.T_start_body, way_m_);
  first_ = sweep;
}

void ScanOdometer::register_on_map(ScanSweep sweep, const Registration& first_fit, const PosePrior& prior,
                                   ScanPose& result) {
  Registration fit = first_fit;
  if (auto start = first_ ? unbend_start(*first_, *last_, sweep, first_fit, prior) : std::nullopt) {
    map_ = std::move(start->map);
    last_ = start->first_place;
    sweep = std::move(start->next);
    result.cloud = std::move(start->next_cloud);
    result.first_cloud = std::move(start->first_cloud);
    fit = start->fit;
  }
  first_.reset();
  fit = unbend(sweep, result.cloud, fit, prior);
  result.matched_share = fit.matched_share;
  result.rms_m = fit.rms_m;
  result.iterations = fit.iterations;
  result.outcome = ScanOutcome::kRegistered;
  result.T_start_body = fit.T_target_source;
  result.covariance = fit.posterior.inverse();
  result.information = told_of_pose(fit.information);
  learn(prior.pose.inverse() * first_fit.T_target_source, fit.matched_share);
  advance(sweep.place_at(result.T_start_body));
  if (result.matched_share >= params_.odometry.insert_share * usual_share_)
    result.new_share = map_.add(result.cloud, result.T_start_body, way_m_);
}

ScanPose ScanOdometer::add(Stamp stamp, const LidarScan& scan, const std::optional<SE3>& T_previous_body) {
  const double dt_s = last_ ? seconds_between(last_->stamp, stamp) : 0;
  SE3 motion = T_previous_body ? *T_previous_body : SE3::exp(dt_s * twist_per_s_);
  if (traits_.kind == ScannerKind::kPlanar) motion = lift(flatten(motion));  // its map is its plane
  const SE3::Tangent twist = T_previous_body && dt_s > 0 ? SE3::Tangent(motion.log() / dt_s) : twist_per_s_;
  const ScanPoints usable = usable_points(scan, twist, params_.points);

  ScanPose result;
  result.stamp = stamp;
  result.T_start_body = last_ ? last_->T_map_body * motion : motion;
  result.counts = usable.counts;
  if (usable.points.size() < kFewestPoints) return result;
  const bool is_anywhere = is_after_gap(stamp) && last_ && !T_previous_body;
  if (is_anywhere) result.T_start_body = last_->T_map_body;
  const ScanSweep sweep =
      sweep_of(stamp, usable, twist, T_previous_body ? MotionSource::kTold : MotionSource::kSoFar);
  result.cloud = cloud_of(sweep);
  result.outcome = ScanOutcome::kUnmatched;
  if (!last_) {
    if (may_be_a_map(result.cloud)) begin(sweep, result);
    return result;
  }
  const PosePrior prior = prior_at(result.T_start_body);
  Registration fit = lay_nearby(result.cloud, prior);
  const bool is_at_home = fit.matched_share >= enough_share();
  const bool is_lost = !is_at_home && may_be_a_map(result.cloud);
  if (is_anywhere && is_lost) {
    begin_after_gap(sweep, result);
    return result;
  }
  if (is_lost) fit = search_afar(result.cloud, prior, fit);
  result.matched_share = fit.matched_share;
  result.rms_m = fit.rms_m;
  result.iterations = fit.iterations;
  const bool may_register = is_at_home || is_lost || deviation_.count > 0;
  if (may_register && fit.matched_share >= least_share()) {
    rival_.reset();
    without_order_ = 0;
    register_on_map(sweep, fit, prior, result);
  } else if (is_lost) {
    try_new_map(sweep, result);
  }
  return result;
}

}  // namespace radioslam
