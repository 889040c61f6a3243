#include "radioslam/odometry/scan_tracking.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "radioslam/base/stamp_intervals.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/continuous_trajectory.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/odometry/imu_motion_prior.hpp"
#include "radioslam/odometry/motion_distortion.hpp"

namespace radioslam {
namespace {

class ScanTracker {
 public:
  ScanTracker(const Robot& robot, ImuUse by, const ScannerTraits& traits, const ScanParams& params,
              const KeyframeParams& keyframes)
      : robot_(robot),
        by_(by),
        params_(params),
        keyframes_(keyframes),
        odometry_(traits, params.lidar),
        imu_prior_(robot.inertial, params.inertial),
        sample_interval_s_(median_interval_s(robot.odometry, &StampedPose<SE3>::stamp)),
        scan_interval_s_(median_interval_s(robot.lidar.stamps)),
        distortion_(params.stage.acceleration_smoothing, scan_interval_s_) {}

  /// Registers scan k of the robot, the next one.
  void add(std::size_t k) {
    const Stamp stamp = robot_.lidar.stamps[k];
    LidarScan scan = robot_.lidar.read(k);
    const ScanTimeSpan time = time_span(scan, params_.lidar.points);
    const std::optional<MotionPrior> prior = select_prior(stamp, time);
    const std::optional<SE3> motion = motion_to(stamp, prior);
    if (prior) scan = deskew(std::move(scan), prior->scan_motion, params_.lidar.points);
    ScanPose pose =
        odometry_.register_scan(stamp, scan, motion, prior ? prior->source : MotionSource::kOdometry,
                                motion ? recorded_covariance(stamp) : SE3::Jacobian::Zero());
    ++track_.status_counts[pose.status];
    track_.points += pose.counts;
    if (!is_tracked(pose.status)) return;
    if (pose.status == ScanStatus::kNewMap) {
      distortion_.start_new_map();
      previous_distortion_.setZero();
      if (track_.poses.size() == 1) forget_start();
    }
    if (by_ == ImuUse::kReadings) imu_prior_.add(pose, prior);
    add_distortion_covariance(pose, prior ? prior->source : MotionSource::kConstantVelocity, time);
    take_first_cloud(std::exchange(pose.first_cloud, std::nullopt));
    append(std::move(pose));
  }

  ScanTrajectory finish() && {
    if (!track_.poses.empty() && track_.keyframes.back() + 1 < track_.poses.size())
      add_keyframe(std::move(last_cloud_));
    track_.nominal_inlier_ratio /= static_cast<double>(std::max<std::size_t>(1, track_.poses.size() - 1));
    return std::move(track_);
  }

 private:
  std::optional<MotionPrior> select_prior(Stamp stamp, const ScanTimeSpan& time) const {
    if (by_ == ImuUse::kReadings)
      if (auto prior = imu_prior_.predict(stamp, time)) return prior;
    std::optional<Stamp> previous;
    if (!track_.poses.empty()) previous = track_.poses.back().stamp;
    const double max_gap_s = params_.stage.max_odometry_gap_ratio * scan_interval_s_;
    return prior_from_odometry(robot_.odometry, previous, stamp, time, max_gap_s);
  }

  /// Motion since the previous scan, unless only the scans measure it.
  std::optional<SE3> motion_to(Stamp stamp, const std::optional<MotionPrior>& prior) const {
    if (prior && prior->T_previous_body) return prior->T_previous_body;
    if (track_.poses.empty()) return std::nullopt;
    return recorded_motion(track_.poses.back().stamp, stamp);
  }

  /// Recorded motion, also across a gap in the scans, but not if recorded odometry has a longer gap there.
  std::optional<SE3> recorded_motion(Stamp from, Stamp to) const {
    const auto a = robot_.odometry.at(from), b = robot_.odometry.at(to);
    if (!a || !b) return std::nullopt;
    const double max_gap_s = std::max(params_.stage.max_odometry_gap_ratio * sample_interval_s_,
                                      params_.lidar.odometry.max_lost_scans * scan_interval_s_);
    if (max_sample_gap_s(robot_.odometry, from, to) > max_gap_s) return std::nullopt;
    return a->inverse() * *b;
  }

  /// Of the recorded motion since the previous scan, if that was some time ago; zero if it is not recorded.
  SE3::Jacobian recorded_covariance(Stamp stamp) const {
    if (track_.poses.empty()) return SE3::Jacobian::Zero();
    const Stamp previous = track_.poses.back().stamp;
    if (seconds_between(previous, stamp) < 2 * scan_interval_s_) return SE3::Jacobian::Zero();  // no gap
    if (!robot_.odometry.covers(previous) || !robot_.odometry.covers(stamp)) return SE3::Jacobian::Zero();
    return odometry_between<SE3>(robot_, previous, stamp).covariance;
  }

  /// Adds the motion distortion of this scan and the previous one to the covariance of the step between them.
  void add_distortion_covariance(ScanPose& pose, MotionSource source, const ScanTimeSpan& time) {
    distortion_.add(pose.stamp, pose.T_start_body);
    const SE3::Tangent variances = distortion_.variances(
        source, time, std::min(sample_interval_s_, scan_interval_s_), pose.cloud.median_range_m);
    pose.covariance.diagonal() += previous_distortion_ + variances;
    previous_distortion_ = variances;
  }

  /// Replaces the last keyframe's cloud if its scan started the map and was deskewed again.
  void take_first_cloud(std::optional<ScanPyramid> cloud) {
    if (cloud && !track_.keyframes.empty() && track_.keyframes.back() + 1 == track_.poses.size())
      track_.clouds.back() = *std::move(cloud);
  }

  void forget_start() {
    track_.poses.clear();
    track_.keyframes.clear();
    track_.clouds.clear();
    track_.nominal_inlier_ratio = 0;
    imu_prior_ = ImuMotionPrior(robot_.inertial, params_.inertial);
  }

  void append(ScanPose pose) {
    last_cloud_ = std::exchange(pose.cloud, {});
    track_.nominal_inlier_ratio += pose.inlier_ratio;
    track_.poses.push_back(std::move(pose));
    if (starts_keyframe()) add_keyframe(last_cloud_);
  }

  /// The last pose of the trajectory becomes a keyframe in finish().
  bool starts_keyframe() const {
    if (track_.keyframes.empty()) return true;
    return is_new_keyframe(track_.poses[track_.keyframes.back()].T_start_body,
                           track_.poses.back().T_start_body, keyframes_);
  }

  void add_keyframe(ScanPyramid cloud) {
    track_.keyframes.push_back(track_.poses.size() - 1);
    track_.clouds.push_back(std::move(cloud));
  }

  const Robot& robot_;
  ImuUse by_;
  const ScanParams& params_;
  const KeyframeParams& keyframes_;
  LidarOdometry odometry_;
  ImuMotionPrior imu_prior_;
  double sample_interval_s_, scan_interval_s_;  ///< nominal, of recorded odometry and of scans
  DistortionCovariance distortion_;
  SE3::Tangent previous_distortion_ = SE3::Tangent::Zero();  ///< variances of the last pose
  ScanTrajectory track_;
  ScanPyramid last_cloud_;  ///< of the last pose
};

using OdometryRows = std::vector<StampedPose<SE3>>;

/// The recorded samples between `begin` and `end`, moved rigidly to pass through `T_start_body` at `at`.
OdometryRows extended_by_odometry(const Trajectory<SE3>& odometry, Stamp begin, Stamp end, Stamp at,
                                  const SE3& T_start_body) {
  OdometryRows rows;
  const auto recorded = odometry.at(at);
  if (!recorded) return rows;
  const SE3 T_start_odometry = T_start_body * recorded->inverse();
  for (const auto& row : odometry)
    if (begin < row.stamp && row.stamp < end) rows.push_back({row.stamp, T_start_odometry * row.pose});
  return rows;
}

/// Noise of a recorded step from the robot's stated random walk.
OdometryStepNoise stated_noise(const StampedPose<SE3>& a, const StampedPose<SE3>& b,
                               const OdometryNoise& noise) {
  const Trajectory<SE3> rows({a, b});
  return {a.stamp, b.stamp,
          odometry_edge<SE3>(rows, 0, 1, noise).covariance / seconds_between(a.stamp, b.stamp)};
}

/// Transform from the scans' frame to the frame of the recorded odometry.
SE3 start_of_scans(const Trajectory<SE3>& odometry, const ScanTrajectory& track) {
  for (const ScanPose& pose : track.poses)
    if (const auto recorded = odometry.at(pose.stamp)) {
      const SE3 T = *recorded * pose.T_start_body.inverse();
      return track.is_level ? lift(flatten(T), T.translation().z()) : T;
    }
  return {};
}

/// Longest step between scans that is not filled by recorded odometry.
double max_scan_step_s(const ScanTrajectory& track, const ScanStageParams& params) {
  return params.max_scan_gap_ratio * median_interval_s(track.poses, &ScanPose::stamp);
}

/// The scans at times that the recorded odometry covers; these are contiguous.
Trajectory<SE3> scans_covered_by(const Trajectory<SE3>& odometry, const std::vector<ScanPose>& scans) {
  OdometryRows rows;
  for (const ScanPose& scan : scans)
    if (odometry.covers(scan.stamp)) rows.push_back({scan.stamp, scan.T_start_body});
  return Trajectory<SE3>(std::move(rows));
}

/// Stamps of recorded samples in gaps between these scans longer than `max_s`.
std::vector<Stamp> stamps_in_gaps(const Trajectory<SE3>& scans, const Trajectory<SE3>& odometry,
                                  double max_s) {
  std::vector<Stamp> stamps;
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const Stamp begin = scans[k - 1].stamp, end = scans[k].stamp;
    if (seconds_between(begin, end) <= max_s) continue;
    auto row = std::upper_bound(odometry.begin(), odometry.end(), begin,
                                [](Stamp s, const auto& r) { return s < r.stamp; });
    for (; row != odometry.end() && row->stamp < end; ++row) stamps.push_back(row->stamp);
  }
  return stamps;
}

/// Recorded samples in gaps between scans, deformed to join the scans on both sides.
OdometryRows fill_gaps(const Robot& robot, const std::vector<ScanPose>& scans, double max_s) {
  const Trajectory<SE3> ends = scans_covered_by(robot.odometry, scans);
  const std::vector<Stamp> stamps = stamps_in_gaps(ends, robot.odometry, max_s);
  if (stamps.empty()) return {};
  const ContinuousTrajectory<SE3> path(robot, {ends, {}});
  const auto poses = path.at(stamps);
  OdometryRows rows;
  for (std::size_t k = 0; k < stamps.size(); ++k) rows.push_back({stamps[k], poses[k].pose});
  return rows;
}

/// Odometry samples, each with the noise of the step to it.
struct OdometryBuilder {
  OdometryRows rows;
  std::vector<OdometryStepNoise> steps;

  /// Appends samples with the robot's stated noise.
  void extend(const OdometryRows& more, const OdometryNoise& stated) {
    for (const auto& row : more) {
      if (!rows.empty()) steps.push_back(stated_noise(rows.back(), row, stated));
      rows.push_back(row);
    }
  }

  /// Appends the scans after the first, which is already present, each preceded by its samples of `bridges`.
  void add_scans(const std::vector<ScanPose>& scans, const OdometryRows& bridges) {
    auto bridge = bridges.begin();
    for (std::size_t k = 1; k < scans.size(); ++k) {
      const auto covariance_per_s =
          (scans[k].covariance / seconds_between(scans[k - 1].stamp, scans[k].stamp)).eval();
      const auto add = [&](const StampedPose<SE3>& row) {
        steps.push_back({rows.back().stamp, row.stamp, covariance_per_s});
        rows.push_back(row);
      };
      for (; bridge != bridges.end() && bridge->stamp < scans[k].stamp; ++bridge) add(*bridge);
      add({scans[k].stamp, scans[k].T_start_body});
    }
  }
};

}  // namespace

ScanTrajectory track_scans(const Robot& robot, std::size_t until, ImuUse by, const ScannerTraits& traits,
                           const ScanParams& params, const KeyframeParams& keyframes,
                           const Progress& progress) {
  ScanTracker tracker(robot, by, traits, params, keyframes);
  for (std::size_t k = 0; k < until; ++k) {
    tracker.add(k);
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(until));
  }
  return std::move(tracker).finish();
}

ScanKeyframes extract_keyframes(ScanTrajectory& track, const ScannerTraits& traits) {
  ScanKeyframes result;
  result.nominal_inlier_ratio = track.nominal_inlier_ratio;
  result.spacing_m = traits.spacing_m;
  result.kind = traits.kind;
  for (std::size_t n = 0; n < track.keyframes.size(); ++n) {
    result.poses.push_back(track.poses[track.keyframes[n]].T_start_body);
    if (n == 0) continue;
    UncertainPose<SE3> step;
    for (std::size_t k = track.keyframes[n - 1] + 1; k <= track.keyframes[n]; ++k)
      step =
          step * UncertainPose<SE3>{track.poses[k - 1].T_start_body.inverse() * track.poses[k].T_start_body,
                                    track.poses[k].covariance};
    result.step_covariances.push_back(step.covariance);
  }
  result.clouds = std::move(track.clouds);
  return result;
}

std::size_t unreachable_samples(const Trajectory<SE3>& recorded, const ScanTrajectory& track) {
  if (track.poses.empty()) return 0;
  const Stamp first = track.poses.front().stamp, last = track.poses.back().stamp;
  const auto is_out_of_reach = [&](const StampedPose<SE3>& row) {
    return (row.stamp < first && !recorded.covers(first)) || (last < row.stamp && !recorded.covers(last));
  };
  return static_cast<std::size_t>(std::count_if(recorded.begin(), recorded.end(), is_out_of_reach));
}

MeasuredOdometry odometry_from_scans(const Robot& robot, ScanTrajectory& track,
                                     const ScanStageParams& params) {
  constexpr Stamp kEver{std::numeric_limits<std::int64_t>::max()},
      kNever{std::numeric_limits<std::int64_t>::min()};
  const SE3 T_start_scans = start_of_scans(robot.odometry, track);
  for (ScanPose& pose : track.poses) pose.T_start_body = T_start_scans * pose.T_start_body;
  const ScanPose &first = track.poses.front(), &last = track.poses.back();
  OdometryNoise stated = robot.odometry_noise;
  stated.steps.clear();
  OdometryBuilder by;
  by.extend(extended_by_odometry(robot.odometry, kNever, first.stamp, first.stamp, first.T_start_body),
            stated);
  by.extend({{first.stamp, first.T_start_body}}, stated);
  by.add_scans(track.poses, fill_gaps(robot, track.poses, max_scan_step_s(track, params)));
  by.extend(extended_by_odometry(robot.odometry, last.stamp, kEver, last.stamp, last.T_start_body), stated);
  return {Trajectory<SE3>(std::move(by.rows)), {0, 0, 0, 0, 0, 0, std::move(by.steps)}};
}

}  // namespace radioslam
