#include "radioslam/pipeline/scan_track.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/base/median.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/pipeline/inertial_guide.hpp"
#include "radioslam/pipeline/sweep_bend.hpp"

namespace radioslam {
namespace {

/// Usually, between two in a row; 0 where there are no two.
double usual_interval_s(const std::vector<Stamp>& stamps) {
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < stamps.size(); ++k)
    intervals_s.push_back(seconds_between(stamps[k - 1], stamps[k]));
  return intervals_s.empty() ? 0 : upper_median(std::move(intervals_s));
}

std::vector<Stamp> stamps_of(const Trajectory<SE3>& rows) {
  std::vector<Stamp> stamps;
  for (const auto& row : rows) stamps.push_back(row.stamp);
  return stamps;
}

class ScanTracker {
 public:
  ScanTracker(const Robot& robot, ScanGuide by, const ScannerTraits& traits, const ScanParams& params,
              const KeyframeParams& keyframes)
      : robot_(robot),
        by_(by),
        params_(params),
        keyframes_(keyframes),
        odometer_(traits, params.lidar),
        guide_(robot.inertial, params.inertial),
        row_interval_s_(usual_interval_s(stamps_of(robot.odometry))),
        scan_interval_s_(usual_interval_s(robot.lidar.stamps)),
        bend_(params.stage.change_share, scan_interval_s_) {}

  /// Scan k of the robot, the next one.
  void add(std::size_t k) {
    const Stamp stamp = robot_.lidar.stamps[k];
    LidarScan scan = robot_.lidar.read(k);
    const SweptTime time = swept_time(scan, params_.lidar.points);
    const Guess guess = guess_of(stamp, time);
    const std::optional<SE3> motion = motion_to(stamp, guess.guess);
    if (guess.guess) scan = unbent(std::move(scan), guess.guess->way, params_.lidar.points);
    ScanPose pose = odometer_.add(stamp, scan, motion);
    ++track_.outcomes[pose.outcome];
    track_.points += pose.counts;
    if (!is_on_the_way(pose.outcome)) return;
    if (pose.outcome == ScanOutcome::kNewMap) {
      bend_.begin_anew();
      bent_before_.setZero();
      if (track_.poses.size() == 1) forget_start();
    }
    if (by_ == ScanGuide::kReadings) guide_.add(pose, guess.guess);
    add_bend(pose, guess.by, time);
    take_first_cloud(std::exchange(pose.first_cloud, std::nullopt));
    append(std::move(pose));
  }

  ScanTrack finish() && {
    if (!track_.poses.empty() && track_.keyframes.back() + 1 < track_.poses.size())
      add_keyframe(std::move(last_cloud_));
    track_.usual_share /= static_cast<double>(std::max<std::size_t>(1, track_.poses.size() - 1));
    return std::move(track_);
  }

 private:
  /// By the first that tells; of recorded rows less often than scans no motion within a sweep is known.
  struct Guess {
    SweptBy by = SweptBy::kScans;
    std::optional<ScanGuess> guess;
  };

  Guess guess_of(Stamp stamp, const SweptTime& time) const {
    if (by_ == ScanGuide::kReadings)
      if (auto guess = guide_.guess(stamp, time)) return {SweptBy::kReadings, std::move(guess)};
    std::optional<Stamp> previous;
    if (!track_.poses.empty()) previous = track_.poses.back().stamp;
    const double most_rows_s = params_.stage.row_steps * scan_interval_s_;
    if (auto guess = guess_by_odometry(robot_.odometry, previous, stamp, time, most_rows_s))
      return {SweptBy::kRecordedRows, std::move(guess)};
    return {};
  }

  /// Since the scan before, where anything but scans tells it.
  std::optional<SE3> motion_to(Stamp stamp, const std::optional<ScanGuess>& guess) const {
    if (guess && guess->T_previous_body) return guess->T_previous_body;
    if (track_.poses.empty()) return std::nullopt;
    return recorded_motion(track_.poses.back().stamp, stamp);
  }

  /// By recorded odometry, also across a gap in the scans, but not where a gap in its rows is longer.
  std::optional<SE3> recorded_motion(Stamp from, Stamp to) const {
    const auto a = robot_.odometry.at(from), b = robot_.odometry.at(to);
    if (!a || !b) return std::nullopt;
    const double most_rows_s = std::max(params_.stage.row_steps * row_interval_s_, seconds_between(from, to));
    if (longest_between_rows_s(robot_.odometry, from, to) > most_rows_s) return std::nullopt;
    return a->inverse() * *b;
  }

  /// What the sweeps of this scan and of the one before leave open of the step between them.
  void add_bend(ScanPose& pose, SweptBy by, const SweptTime& time) {
    bend_.add(pose.stamp, pose.T_start_body);
    const SE3::Tangent variances =
        bend_.variances(by, time, std::min(row_interval_s_, scan_interval_s_), pose.cloud.median_range_m);
    pose.covariance.diagonal() += bent_before_ + variances;
    bent_before_ = variances;
  }

  /// The last keyframe's cloud, if it began the map.
  void take_first_cloud(std::optional<ScanCloud> cloud) {
    if (cloud && !track_.keyframes.empty() && track_.keyframes.back() + 1 == track_.poses.size())
      track_.clouds.back() = *std::move(cloud);
  }

  void forget_start() {
    track_.poses.clear();
    track_.keyframes.clear();
    track_.clouds.clear();
    track_.usual_share = 0;
    guide_ = InertialGuide(robot_.inertial, params_.inertial);
  }

  void append(ScanPose pose) {
    last_cloud_ = std::exchange(pose.cloud, {});
    track_.usual_share += pose.matched_share;
    track_.poses.push_back(std::move(pose));
    if (starts_keyframe()) add_keyframe(last_cloud_);
  }

  /// But for the last pose, which is not known to be the last yet.
  bool starts_keyframe() const {
    if (track_.keyframes.empty()) return true;
    return is_new_keyframe(track_.poses[track_.keyframes.back()].T_start_body,
                           track_.poses.back().T_start_body, keyframes_);
  }

  void add_keyframe(ScanCloud cloud) {
    track_.keyframes.push_back(track_.poses.size() - 1);
    track_.clouds.push_back(std::move(cloud));
  }

  const Robot& robot_;
  ScanGuide by_;
  const ScanParams& params_;
  const KeyframeParams& keyframes_;
  ScanOdometer odometer_;
  InertialGuide guide_;
  double row_interval_s_, scan_interval_s_;  ///< usually, of recorded odometry and of scans
  SweepBend bend_;
  SE3::Tangent bent_before_ = SE3::Tangent::Zero();  ///< variances of the last pose
  ScanTrack track_;
  ScanCloud last_cloud_;  ///< of the last pose
};

}  // namespace

ScanTrack track_scans(const Robot& robot, std::size_t until, ScanGuide by, const ScannerTraits& traits,
                      const ScanParams& params, const KeyframeParams& keyframes, const Progress& progress) {
  ScanTracker tracker(robot, by, traits, params, keyframes);
  for (std::size_t k = 0; k < until; ++k) {
    tracker.add(k);
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(until));
  }
  return std::move(tracker).finish();
}

ScanKeyframes take_keyframes(ScanTrack& track, const ScannerTraits& traits) {
  ScanKeyframes result;
  result.usual_share = track.usual_share;
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

}  // namespace radioslam
