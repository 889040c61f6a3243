#include "radioslam/odometry/scan_front_end.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "radioslam/odometry/lidar_inertial_smoothing.hpp"

namespace radioslam {
namespace {

constexpr double kMinPatience_s = 0.3;
/// Of the map of a planar scanner, whose few points need no thinning: where it starts in a wide hall, the map
/// would be too coarse for the rooms to come. Without a prediction it must reach from scan to scan.
constexpr double kMaxPlanarSpacing_m = 0.12;
constexpr Stamp kNever{std::numeric_limits<std::int64_t>::min()};

Stamp after(Stamp stamp, double s) { return {stamp.ns + Stamp::from_seconds(s).ns}; }

std::optional<Stamp> newest(const std::optional<ScanTracker>& tracker) {
  if (!tracker || tracker->track().poses.empty()) return std::nullopt;
  return tracker->track().poses.back().stamp;
}

}  // namespace

ScanFrontEnd::ScanFrontEnd(const Robot& robot, MotionSources sources, const ScanParams& params,
                           const KeyframeParams& keyframes, CloudStore& clouds)
    : params_(params),
      keyframes_(keyframes),
      clouds_(clouds),
      sources_(sources),
      history_(robot),
      outliers_(params.inertial.outliers),
      now_(kNever),
      last_odometry_(kNever) {
  sources_.inertial = sources.inertial && params.inertial.stage.enabled;
  if (sources_.inertial) gate_.emplace(params.inertial);
}

void ScanFrontEnd::add(const StampedPose<SE3>& odometry) {
  history_.add(odometry);
  last_odometry_ = odometry.stamp;
  advance(odometry.stamp);
}

void ScanFrontEnd::add(const ImuSample& sample) {
  if (sources_.inertial) outliers_.add(sample, history_.inertial());
  advance(sample.stamp);
}

void ScanFrontEnd::add(Stamp stamp, LidarScan scan) {
  history_.add(stamp);
  const double last_s = time_span(scan, params_.lidar.points).last_s;
  waiting_.push_back({stamp, std::max(stamp, after(stamp, last_s)), std::move(scan)});
  advance(stamp);
}

void ScanFrontEnd::register_waiting() {
  if (sources_.inertial) outliers_.finish(history_.inertial());
  if (!traits_ && !waiting_.empty()) start();
  while (!waiting_.empty()) {
    register_scan(std::move(waiting_.front()));
    waiting_.pop_front();
  }
}

TrackedScans ScanFrontEnd::finish() {
  register_waiting();
  TrackedScans tracked;
  if (traits_) tracked.track = take_track();
  tracked.traits = traits_;
  if (gate_ && gate_->trust() == ImuTrust::kRejected) tracked.imu_fault = gate_->reason();
  tracked.follows_imu = gate_ && gate_->trust() == ImuTrust::kTrusted;
  tracked.imu_outliers = outliers_.removed();
  return tracked;
}

ScanTrajectory ScanFrontEnd::take_track() {
  if (gate_ && alone_) gate_->conclude(alone_->track().poses, history_.inertial());
  if (!gate_ || gate_->trust() == ImuTrust::kRejected)
    return std::move(alone_ ? *alone_ : *with_imu_).finish();
  ScanTrajectory together = std::move(*with_imu_).finish();
  if (together.poses.empty()) return together;
  if (auto wrong = smooth_with_imu(together, history_.inertial(), params_.inertial)) {
    gate_->reject(std::move(*wrong));
    if (alone_) return std::move(*alone_).finish();
  }
  return together;
}

const ScanTrajectory* ScanFrontEnd::track() const {
  if (uses_imu()) return &with_imu_->track();
  return alone_ ? &alone_->track() : nullptr;
}

std::optional<ScanTrajectory> ScanFrontEnd::revised() {
  constexpr double kGrowth = 1.25;
  constexpr std::size_t kMinPoses = 50;
  const bool has_changed = uses_imu() != has_used_imu_;
  const auto poses = track() ? track()->poses.size() : 0;
  const bool has_grown =
      poses >= kMinPoses && static_cast<double>(poses) > kGrowth * static_cast<double>(revised_poses_);
  if (!(has_changed || (uses_imu() && has_grown))) return std::nullopt;
  has_used_imu_ = uses_imu();
  revised_poses_ = poses;
  ScanTrajectory again;
  again.poses = track()->poses;
  again.is_level = track()->is_level;
  if (uses_imu()) smooth_with_imu(again, history_.inertial(), params_.inertial);
  return again;
}

void ScanFrontEnd::advance(Stamp stamp) {
  now_ = std::max(now_, stamp);
  if (!traits_) {
    const bool shows_scanner =
        waiting_.size() >= kTraitScans ||
        (waiting_.size() >= 2 && seconds_between(waiting_.front().stamp, now_) >= kStart_s);
    if (!shows_scanner) return;
    start();
  }
  while (!waiting_.empty() && has_passed(waiting_.front().end)) {
    register_scan(std::move(waiting_.front()));
    waiting_.pop_front();
  }
}

bool ScanFrontEnd::has_passed(Stamp end) const {
  if (now_ >= after(end, std::max(kMinPatience_s, 2 * history_.scan_interval_s()))) return true;
  const bool odometry = !sources_.odometry || last_odometry_ >= end;
  const bool inertial =
      !sources_.inertial || (!history_.inertial().empty() && history_.inertial().back().stamp >= end);
  return odometry && inertial;
}

void ScanFrontEnd::start() {
  std::vector<LidarScan> scans;
  for (std::size_t k = 0; k < std::min(waiting_.size(), kTraitScans); ++k) scans.push_back(waiting_[k].scan);
  traits_ = scanner_traits(scans, params_.lidar);
  const LidarOdometryParams& odometry = params_.lidar.odometry;
  if (traits_->kind == ScannerKind::kPlanar && sources_.odometry && odometry.spacing_m == 0)
    traits_->spacing_m = std::min(traits_->spacing_m, std::max(kMaxPlanarSpacing_m, odometry.min_spacing_m));
  alone_.emplace(history_, ImuUse::kNone, *traits_, params_, keyframes_, clouds_);
  if (gate_) with_imu_.emplace(history_, ImuUse::kReadings, *traits_, params_, keyframes_, clouds_);
}

void ScanFrontEnd::register_scan(WaitingScan scan) {
  history_.update();
  if (alone_ && with_imu_) with_imu_->add(scan.stamp, scan.scan);
  (alone_ ? *alone_ : *with_imu_).add(scan.stamp, std::move(scan.scan));
  const ScanTracker& tested = alone_ ? *alone_ : *with_imu_;
  if (gate_ && gate_->test(tested.track().poses, history_.inertial())) follow_gate();
  const auto by_alone = newest(alone_), by_imu = newest(with_imu_);
  if (by_alone || by_imu) history_.forget_before(std::min(by_alone.value_or(now_), by_imu.value_or(now_)));
}

void ScanFrontEnd::follow_gate() {
  if (gate_->trust() == ImuTrust::kTrusted) {
    alone_.reset();
    return say("its IMU agrees with its scans and is used from now on");
  }
  say(gate_->reason() + "; its IMU data is ignored from now on");
  if (alone_)
    with_imu_.reset();
  else
    with_imu_->leave_out_imu();
}

}  // namespace radioslam
