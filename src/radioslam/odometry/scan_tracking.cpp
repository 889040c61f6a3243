#include "radioslam/odometry/scan_tracking.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "radioslam/base/stamp_intervals.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/continuous_trajectory.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

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
Trajectory<SE3> scans_covered_by(const Trajectory<SE3>& odometry, const ScanPoses& scans,
                                 const SE3& T_start_scans) {
  OdometryRows rows;
  for (const ScanPose& scan : scans)
    if (odometry.covers(scan.stamp)) rows.push_back({scan.stamp, T_start_scans * scan.T_start_body});
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
OdometryRows fill_gaps(const Robot& robot, const ScanPoses& scans, const SE3& T_start_scans, double max_s) {
  const Trajectory<SE3> ends = scans_covered_by(robot.odometry, scans, T_start_scans);
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
  void add_scans(const ScanPoses& scans, const SE3& T_start_scans, const OdometryRows& bridges) {
    auto bridge = bridges.begin();
    for (std::size_t k = 1; k < scans.size(); ++k) {
      const auto covariance_per_s =
          (scans[k].covariance / seconds_between(scans[k - 1].stamp, scans[k].stamp)).eval();
      const auto add = [&](const StampedPose<SE3>& row) {
        steps.push_back({rows.back().stamp, row.stamp, covariance_per_s});
        rows.push_back(row);
      };
      for (; bridge != bridges.end() && bridge->stamp < scans[k].stamp; ++bridge) add(*bridge);
      add({scans[k].stamp, T_start_scans * scans[k].T_start_body});
    }
  }
};

}  // namespace

ScanKeyframes extract_keyframes(const ScanTrajectory& track, const ScannerTraits& traits) {
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
  result.clouds = track.clouds;
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

MeasuredOdometry odometry_from_scans(const Robot& robot, const ScanTrajectory& track,
                                     const ScanStageParams& params) {
  constexpr Stamp kEver{std::numeric_limits<std::int64_t>::max()},
      kNever{std::numeric_limits<std::int64_t>::min()};
  const SE3 T_start_scans = start_of_scans(robot.odometry, track);
  const auto end_of = [&](const ScanPose& scan) {
    return StampedPose<SE3>{scan.stamp, T_start_scans * scan.T_start_body};
  };
  const StampedPose<SE3> first = end_of(track.poses.front()), last = end_of(track.poses.back());
  OdometryNoise stated = robot.odometry_noise;
  stated.steps.clear();
  OdometryBuilder by;
  by.extend(extended_by_odometry(robot.odometry, kNever, first.stamp, first.stamp, first.pose), stated);
  by.extend({first}, stated);
  by.add_scans(track.poses, T_start_scans,
               fill_gaps(robot, track.poses, T_start_scans, max_scan_step_s(track, params)));
  by.extend(extended_by_odometry(robot.odometry, last.stamp, kEver, last.stamp, last.pose), stated);
  return {Trajectory<SE3>(std::move(by.rows)), {0, 0, 0, 0, 0, 0, std::move(by.steps)}};
}

}  // namespace radioslam
