#include "radioslam/odometry/scan_stage.hpp"

#include <algorithm>
#include <iomanip>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_front_end.hpp"
#include "radioslam/odometry/scans_on_odometry.hpp"

namespace radioslam {
namespace {

/// A robot without odometry and registered scans stays at the origin from its first scan on.
ScanOdometry static_odometry(const Robot& robot) {
  return {MeasuredOdometry{Trajectory<SE3>({{robot.lidar.stamps.front(), SE3()}}), robot.odometry_noise},
          {},
          {},
          {}};
}

ScanOdometry recorded_odometry_with_scans(const Robot& robot, const ScanParams& params,
                                          const KeyframeParams& keyframes, CloudStore& clouds) {
  const ScannerTraits traits = scanner_traits(robot.lidar, params.lidar);
  ScansOnOdometry scans = scans_on_odometry(robot, traits, params.lidar, keyframes, clouds);
  return {std::nullopt, std::move(scans.keyframes), std::move(scans.stamps), {}};
}

/// Whether a spatial scanner's points leave a direction of the plane open at this pose.
bool is_open(const SE3::Jacobian& information) {
  constexpr double kOpenSigma_m = 0.5;
  const auto axes = symmetric_eigen_direct(information.topLeftCorner<2, 2>());
  return axes.values.minCoeff() < 1 / (kOpenSigma_m * kOpenSigma_m);
}

/// Whether all walls that a planar scanner sees are parallel. The information of its points does not show
/// that: noisy normals pretend the rest.
bool has_parallel_walls(const std::vector<Surfel>& cloud) {
  constexpr double kFlat = 20, kCosine = 0.8, kMaxAcrossRatio = 0.01;
  std::vector<Eigen::Vector2d> normals;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Surfel& surfel : cloud) {
    const auto axes = symmetric_eigen_direct(surfel.covariance.topLeftCorner<2, 2>().cast<double>());
    if (axes.values[1] < kFlat * axes.values[0]) continue;
    normals.push_back(axes.vectors.col(0));
    scatter += normals.back() * normals.back().transpose();
  }
  const Eigen::Vector2d main = symmetric_eigen_direct(scatter).vectors.col(1);
  const auto across = std::count_if(normals.begin(), normals.end(),
                                    [&](const auto& n) { return std::abs(n.dot(main)) < kCosine; });
  return static_cast<double>(across) <= kMaxAcrossRatio * static_cast<double>(normals.size());
}

/// Per pose, whether its scan leaves a direction of the plane open, as along a corridor; a planar one by the
/// keyframe before.
std::vector<bool> open_poses(const ScanTrajectory& track, ScannerKind kind) {
  std::vector<bool> open;
  std::size_t next = 0;
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    const bool is_keyframe = next < track.keyframes.size() && track.keyframes[next] == k;
    if (kind == ScannerKind::kSpatial)
      open.push_back(is_open(track.poses[k].information));
    else
      open.push_back(is_keyframe ? has_parallel_walls(track.clouds[next].read()->all)
                                 : !open.empty() && open.back());
    next += is_keyframe;
  }
  return open;
}

/// Time in which nothing measures the motion: the scans leave a direction open and neither an IMU nor
/// recorded odometry predicts it. The speed before is carried on there, or noise followed, and the steps'
/// covariances do not show how wrong that is; nor does the length of the estimated path, which may be zero.
struct GuessedTime {
  double all_s = 0, longest_s = 0, longest_m = 0;
  Stamp begin, end;  ///< of the longest stretch

  GuessedTime(const ScanTrajectory& track, ScannerKind kind, const Trajectory<SE3>& recorded) {
    const std::vector<bool> open = open_poses(track, kind);
    double stretch_m = 0;
    Stamp from = track.poses.empty() ? Stamp() : track.poses.front().stamp;
    for (std::size_t k = 1; k < track.poses.size(); ++k) {
      const ScanPose &last = track.poses[k - 1], &pose = track.poses[k];
      if (!open[k] || track.is_level || recorded.covers(pose.stamp) ||
          pose.status != ScanStatus::kRegistered) {
        stretch_m = 0, from = pose.stamp;
        continue;
      }
      all_s += seconds_between(last.stamp, pose.stamp);
      stretch_m += (last.T_start_body.inverse() * pose.T_start_body).translation().norm();
      longest_m = std::max(longest_m, stretch_m);
      if (const double length_s = seconds_between(from, pose.stamp); length_s > longest_s)
        longest_s = length_s, begin = from, end = pose.stamp;
    }
  }
};

void report_guessed_time(MeasuredScans& measured, const Robot& robot, const ScanTrajectory& track,
                         ScannerKind kind) {
  // Beside one wall of a hall a planar scanner may see no other for some metres.
  const double min_length = kind == ScannerKind::kSpatial ? 5 : 20;  // metres, or seconds
  const GuessedTime guessed(track, kind, robot.odometry);
  if (guessed.longest_s < min_length && guessed.longest_m < min_length) return;
  std::ostringstream note;
  note << std::fixed << std::setprecision(0) << "robot " << robot.id << ": for " << guessed.all_s
       << " s, most of them from " << guessed.begin.seconds() << " to " << guessed.end.seconds()
       << " s, its scans look alike along one direction, as in a corridor, and neither an IMU nor recorded "
          "odometry measures the motion: the position along it is a guess with too small a sigma, except "
          "where ranges or fixes correct it; record an IMU or wheel odometry";
  measured.notes.push_back(note.str());
}

/// Counts the robot's scans and notes problems.
void report_scans(MeasuredScans& measured, const Robot& robot, const ScanTrajectory& track) {
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count > 0) measured.notes.push_back("robot " + robot.id + ": " + std::to_string(count) + ' ' + what);
  };
  const auto status = [&](ScanStatus o) {
    return track.status_counts.contains(o) ? track.status_counts.at(o) : 0;
  };
  measured.scans += robot.lidar.size();
  measured.registered += track.poses.size();
  measured.too_few += status(ScanStatus::kTooFewPoints);
  measured.lost += status(ScanStatus::kLost);
  note(status(ScanStatus::kTooFewPoints), "scans had too few points and were skipped");
  note(status(ScanStatus::kLost), "scans did not match the map and were skipped");
  note(status(ScanStatus::kNewMap),
       "tracking losses (scans missing or not matching for long): a new map was started each time, and the "
       "motion in between is known by its odometry at best");
  note(track.points.not_finite, "points or their times were not finite and were ignored");
  note(track.points.off_time,
       "points were more than scan_points.max_time_s from their scan's stamp and were ignored");
  note(track.points.far, "points were beyond scan_points.max_range_m and were ignored");
  note(unreachable_samples(robot.odometry, track),
       "rows of recorded odometry could not be connected to its scans and were dropped");
}

void close_loops(MeasuredScans& measured, RobotIndex robot, ScanOdometry& scans, const ScanLoopSearch& search,
                 const Progress& progress) {
  ScanLoops loops = close_scan_loops(scans.keyframes, search, progress);
  for (const ScanLoop& loop : loops.loops)
    measured.closures.push_back({robot, scans.keyframe_stamps[loop.i], scans.keyframe_stamps[loop.j], loop});
  if (!loops.loops.empty()) scans.corrected = std::move(loops.poses);
}

/// Whether the robot's odometry is that of its scans.
bool is_tracked(const Robot& robot, const ScanParams& params) {
  const bool is_recorded =
      odometry_source(params.stage) == OdometrySource::kRecorded && !robot.odometry.empty();
  return !robot.lidar.empty() && !is_recorded;
}

/// Tracks the recorded scans, sample by sample.
TrackedScans track_recorded(const Robot& robot, const ScanParams& params, const KeyframeParams& keyframes,
                            CloudStore& clouds, const Progress& progress) {
  ScanFrontEnd front_end(robot, {!robot.odometry.empty(), !robot.inertial.empty()}, params, keyframes,
                         clouds);
  auto odometry = robot.odometry.begin();
  auto sample = robot.inertial.begin();
  for (std::size_t k = 0; k < robot.lidar.size(); ++k) {
    const Stamp stamp = robot.lidar.stamps[k];
    const auto is_next = [&](const auto& of, const auto& end) { return of != end && of->stamp <= stamp; };
    while (is_next(odometry, robot.odometry.end()) || is_next(sample, robot.inertial.end())) {
      const bool is_odometry = odometry != robot.odometry.end() &&
                               (sample == robot.inertial.end() || odometry->stamp <= sample->stamp);
      is_odometry ? front_end.add(*odometry++) : front_end.add(*sample++);
    }
    front_end.add(stamp, robot.lidar.read(k));
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(robot.lidar.size()));
  }
  for (; odometry != robot.odometry.end(); ++odometry) front_end.add(*odometry);
  for (; sample != robot.inertial.end(); ++sample) front_end.add(*sample);
  return front_end.finish();
}

void report_imu(MeasuredScans& measured, const Robot& robot, const TrackedScans& tracked) {
  if (tracked.imu_outliers > 0)
    measured.notes.push_back("robot " + robot.id + ": " + std::to_string(tracked.imu_outliers) +
                             " IMU samples are outliers and were removed");
  if (tracked.imu_fault)
    measured.notes.push_back("robot " + robot.id + ": " + *tracked.imu_fault + "; its IMU data was ignored");
}

/// What one robot's scans say; `measured` is empty.
void measure_robot(const Robot& robot, RobotIndex index, const ScanParams& params,
                   const KeyframeParams& keyframes, const ScanLoopSearch& loops, ScansOfRecorded recorded,
                   CloudStore& clouds, const Progress& progress, std::optional<TrackedScans> tracked,
                   MeasuredScans& measured) {
  std::optional<ScanOdometry>& scans = measured.robots.emplace_back();
  if (!is_tracked(robot, params)) {
    if (recorded == ScansOfRecorded::kForPlaces && !robot.lidar.empty())
      scans = recorded_odometry_with_scans(robot, params, keyframes, clouds);
    return;
  }
  if (!tracked) tracked = track_recorded(robot, params, keyframes, clouds, progress);
  ScanTrajectory& track = tracked->track;
  report_imu(measured, robot, *tracked);
  report_scans(measured, robot, track);
  if (track.poses.empty()) {
    if (robot.odometry.empty()) scans = static_odometry(robot);
    return;
  }
  report_guessed_time(measured, robot, track, tracked->traits->kind);
  scans.emplace();
  scans->keyframes = extract_keyframes(track, *tracked->traits);
  scans->odometry = odometry_from_scans(robot, track, params.stage);
  if (tracked->follows_imu) scans->by_imu = {track.poses.front().stamp, track.poses.back().stamp};
  for (const std::size_t k : track.keyframes) scans->keyframe_stamps.push_back(track.poses[k].stamp);
  tracked.reset();  // an hour's poses are as large as all that the search of loops keeps
  close_loops(measured, index, *scans, loops, progress);
}

void append(MeasuredScans& to, MeasuredScans of_robot) {
  for (auto& scans : of_robot.robots) to.robots.push_back(std::move(scans));
  to.closures.insert(to.closures.end(), of_robot.closures.begin(), of_robot.closures.end());
  to.notes.insert(to.notes.end(), of_robot.notes.begin(), of_robot.notes.end());
  to.scans += of_robot.scans;
  to.registered += of_robot.registered;
  to.too_few += of_robot.too_few;
  to.lost += of_robot.lost;
}

}  // namespace

ScanLoopSearch loop_search(const ScanParams& params, const PlaceDescriptorParams& descriptors,
                           int dimension) {
  return {params.loops,  params.lidar.map,
          params.search, params.lidar.registration,
          descriptors,   dimension == 3 ? Storeys::kSeveral : Storeys::kOne};
}

MeasuredScans measure_scans(const Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress, ScansOfRecorded recorded,
                            const PlaceDescriptorParams& descriptors,
                            std::vector<std::optional<TrackedScans>> tracked) {
  tracked.resize(mission.robots.size());
  const ScanLoopSearch loops = loop_search(params, descriptors, mission.dimension);
  CloudStore clouds(params.clouds);
  std::mutex reporting;
  const Progress report = [&](std::string_view stage, double fraction) {
    const std::lock_guard lock(reporting);
    report_progress(progress, stage, fraction);
  };
  std::vector<MeasuredScans> of_robots(mission.robots.size());
  parallel_for(of_robots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      measure_robot(mission.robots[r], RobotIndex(r), params, keyframes, loops, recorded, clouds, report,
                    std::move(tracked[r]), of_robots[r]);
  });
  MeasuredScans measured;
  for (MeasuredScans& of_robot : of_robots) append(measured, std::move(of_robot));
  return measured;
}

Mission with_odometry(Mission mission, const MeasuredScans& measured, const KeyframeParams& keyframes) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    if (!measured.robots[r]) continue;
    const ScanOdometry& scans = *measured.robots[r];
    Robot& robot = mission.robots[r];
    if (scans.odometry) {
      robot.odometry = scans.odometry->samples;
      robot.odometry_noise = scans.odometry->noise;
    }
    robot.keyframes = choose_keyframes(mission, RobotIndex(r), keyframes, scans.keyframe_stamps);
  }
  return mission;
}

}  // namespace radioslam
