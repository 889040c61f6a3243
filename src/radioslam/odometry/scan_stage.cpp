#include "radioslam/odometry/scan_stage.hpp"

#include <algorithm>
#include <iomanip>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/inertial/preintegration.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/odometry/inertial_params.hpp"
#include "radioslam/odometry/map_drift.hpp"
#include "radioslam/odometry/scan_tracking.hpp"
#include "radioslam/odometry/scans_on_odometry.hpp"

namespace radioslam {
namespace {

// LiDAR-inertial odometry: smooths a robot's registered scans together with its IMU samples.
//
// The smoother (inertial/inertial_smoother.hpp) estimates all states at once. A scan contributes the
// information of its points, which is none along a featureless corridor; the map drifts as it grows
// (map_drift.hpp), so that on revisited ground scan poses do not drift. States are at least `node_s` apart,
// because errors of successive scans are strongly correlated; poses in between follow the IMU, or the scans
// where IMU samples are missing.

/// Result of smoothing; z is up.
struct InertialOdometry {
  std::vector<SE3> poses;                ///< of the scans
  std::vector<OdometryStepNoise> steps;  ///< between successive states
  double cost_per_step = 0;              ///< squared norm of the residuals per step
};

SE3::Jacobian drift_between(const std::vector<ScanPose>& scans, std::size_t from, std::size_t to,
                            const InertialStageParams& params) {
  MapDrift drift(scans[from], params);
  for (std::size_t k = from + 1; k <= to; ++k) drift.add(scans[k]);
  return drift.covariance();
}

/// Indices of the scans with a state: the first, the last, those at least `node_s` after the previous one,
/// and the scans on either side of a new map's start.
std::vector<std::size_t> nodes_of(const std::vector<ScanPose>& scans, double node_s) {
  std::vector<std::size_t> nodes;
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (nodes.empty() || k + 1 == scans.size() || scans[k].status == ScanStatus::kNewMap ||
        scans[k + 1].status == ScanStatus::kNewMap ||
        seconds_between(scans[nodes.back()].stamp, scans[k].stamp) >= node_s)
      nodes.push_back(k);
  return nodes;
}

/// The body's poses at the scans, starting from `state`, by the IMU, or by the scans if IMU samples are
/// missing.
std::vector<SE3> path_from(const InertialState& state, std::span<const ScanPose> scans,
                           const std::vector<ImuSample>& samples, const ImuNoiseParams& noise) {
  std::vector<Stamp> stamps;
  for (const ScanPose& scan : scans) stamps.push_back(scan.stamp);
  std::vector<SE3> path;
  if (const auto states = predict_motion(state, stamps.front(), samples, stamps, noise))
    for (const InertialState& there : *states) path.push_back(there.T_world_body);
  else
    for (const ScanPose& scan : scans)
      path.push_back(state.T_world_body * scans.front().T_start_body.inverse() * scan.T_start_body);
  return path;
}

/// The body's poses at all scans: the predicted path between nodes, its end error spread evenly in time.
std::vector<SE3> poses_through(const std::vector<ScanPose>& scans, const std::vector<std::size_t>& nodes,
                               const std::vector<InertialState>& states,
                               const std::vector<ImuSample>& samples, const ImuNoiseParams& noise) {
  std::vector<SE3> poses{states.front().T_world_body};
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    const std::span<const ScanPose> span(scans.data() + nodes[n - 1], nodes[n] - nodes[n - 1] + 1);
    const std::vector<SE3> path = path_from(states[n - 1], span, samples, noise);
    const SE3::Tangent missing = (path.back().inverse() * states[n].T_world_body).log();
    const double duration_s = seconds_between(span.front().stamp, span.back().stamp);
    for (std::size_t k = 1; k < path.size(); ++k)
      poses.push_back(path[k] *
                      SE3::exp(seconds_between(span.front().stamp, span[k].stamp) / duration_s * missing));
  }
  return poses;
}

/// Nothing if gravity cannot be estimated or the smoother refuses.
std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<ImuSample>& samples,
                                             const InertialParams& params) {
  const auto aligned = align_gravity(trajectory_of(scans), samples, params.noise, params.alignment);
  if (!aligned) return std::nullopt;
  const auto nodes = nodes_of(scans, params.stage.node_s);
  InertialDrive drive;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    drive.stamps.push_back(scans[nodes[n]].stamp);
    drive.poses.push_back(map_pose(scans[nodes[n]], params.stage));
    if (n > 0) drive.map_drifts.push_back(drift_between(scans, nodes[n - 1], nodes[n], params.stage));
  }
  drive.start = aligned->states.front();
  const auto smoothed = smooth_inertially(drive, samples, params.noise, params.smoother);
  if (!smoothed) return std::nullopt;
  return InertialOdometry{
      poses_through(scans, nodes, smoothed->states, samples, params.noise),
      odometry_noise_inflation(*smoothed, params.odometry_noise),
      smoothed->cost / static_cast<double>(std::max<std::size_t>(1, drive.map_drifts.size()))};
}

// Tracks a robot's scans together with its IMU, or without it if the IMU data is inconsistent with the scans.
//
//   outliers        single IMU outliers are removed                (inertial/imu_outliers.hpp)
//   consistency     of the IMU with the first `check_s` of scans   (inertial/imu_consistency.hpp)
//   tracking        all scans, with the IMU as motion prior        (scan_tracking.hpp)
//   smoothing       poses from scans and IMU together
//
// If the consistency test or the smoother finds a contradiction, or gravity cannot be estimated, the IMU is
// ignored with a note.
// Cost: the scans' registrations; with an IMU, those of the first `check_s` seconds twice.

bool uses_inertial(const Robot& robot, const ScanParams& params) {
  return params.inertial.stage.enabled && !robot.inertial.empty();
}

void remove_outliers(Robot& robot, const ImuOutlierParams& params, std::vector<std::string>& notes) {
  FilteredImu filtered = remove_imu_outliers(robot.inertial, params);
  if (filtered.removed == 0) return;
  robot.inertial = std::move(filtered.samples);
  notes.push_back("robot " + robot.id + ": " + std::to_string(filtered.removed) +
                  " IMU samples are outliers and were removed");
}

/// Replaces the estimate from scans alone by that from scans and IMU; returns why if it cannot.
std::optional<std::string> smooth_with_imu(ScanTrajectory& track, const std::vector<ImuSample>& samples,
                                           const InertialParams& params) {
  const auto smoothed = smooth_scans(track.poses, samples, params);
  if (!smoothed) return "gravity could not be estimated from its IMU data and scans";
  if (smoothed->cost_per_step > params.stage.max_cost_per_step) return "its IMU data contradicts its scans";
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    track.poses[k].T_start_body = smoothed->poses[k];
    if (k == 0) continue;
    const Stamp begin = track.poses[k - 1].stamp, end = track.poses[k].stamp;
    track.poses[k].covariance = measured_covariance(smoothed->steps, begin, end);
  }
  track.is_level = true;
  return std::nullopt;
}

/// Number of scans within the first `duration_s`.
std::size_t scans_within(const LidarLog& log, double duration_s) {
  std::size_t count = 0;
  while (count < log.size() && seconds_between(log.stamps.front(), log.stamps[count]) <= duration_s) ++count;
  return count;
}

/// Removes IMU outliers from `robot`.
ScanTrajectory track_scans_with_imu(Robot& robot, const ScannerTraits& traits, const ScanParams& params,
                                    const KeyframeParams& keyframes, const Progress& progress,
                                    std::vector<std::string>& notes) {
  const auto track = [&](std::size_t until, ImuUse by) {
    return track_scans(robot, until, by, traits, params, keyframes, progress);
  };
  const std::size_t all = robot.lidar.size();
  if (!uses_inertial(robot, params)) return track(all, ImuUse::kNone);
  remove_outliers(robot, params.inertial.outliers, notes);
  const std::size_t checked = scans_within(robot.lidar, params.inertial.stage.check_s);
  ScanTrajectory alone = track(checked, ImuUse::kNone);
  auto wrong = find_inconsistency(trajectory_of(alone.poses), robot.inertial, params.inertial.noise,
                                  params.inertial.consistency);
  if (!wrong) {
    ScanTrajectory together = track(all, ImuUse::kReadings);
    if (together.poses.empty()) return together;
    wrong = smooth_with_imu(together, robot.inertial, params.inertial);
    if (!wrong) return together;
  }
  notes.push_back("robot " + robot.id + ": " + *wrong + "; its IMU data was ignored");
  return checked == all ? std::move(alone) : track(all, ImuUse::kNone);
}

/// A robot without odometry and registered scans stays at the origin from its first scan on.
ScanOdometry static_odometry(const Robot& robot) {
  return {MeasuredOdometry{Trajectory<SE3>({{robot.lidar.stamps.front(), SE3()}}), robot.odometry_noise},
          {},
          {},
          {}};
}

ScanOdometry recorded_odometry_with_scans(const Robot& robot, const ScanParams& params,
                                          const KeyframeParams& keyframes) {
  const ScannerTraits traits = scanner_traits(robot.lidar, params.lidar);
  ScansOnOdometry scans = scans_on_odometry(robot, traits, params.lidar, keyframes);
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
      open.push_back(is_keyframe ? has_parallel_walls(track.clouds[next].all) : !open.empty() && open.back());
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

}  // namespace

MeasuredScans measure_scans(const Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress, ScansOfRecorded recorded,
                            const PlaceDescriptorParams& descriptors) {
  const ScanLoopSearch loops{params.loops,  params.lidar.map,
                             params.search, params.lidar.registration,
                             descriptors,   mission.dimension == 3 ? Storeys::kSeveral : Storeys::kOne};
  MeasuredScans measured;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    std::optional<ScanOdometry>& scans = measured.robots.emplace_back();
    if (!is_tracked(mission.robots[r], params)) {
      if (recorded == ScansOfRecorded::kForPlaces && !mission.robots[r].lidar.empty())
        scans = recorded_odometry_with_scans(mission.robots[r], params, keyframes);
      continue;
    }
    Robot robot = mission.robots[r];
    const ScannerTraits traits = scanner_traits(robot.lidar, params.lidar);
    ScanTrajectory track = track_scans_with_imu(robot, traits, params, keyframes, progress, measured.notes);
    report_scans(measured, robot, track);
    report_guessed_time(measured, robot, track, traits.kind);
    if (track.poses.empty()) {
      if (robot.odometry.empty()) scans = static_odometry(robot);
      continue;
    }
    scans.emplace();
    scans->keyframes = extract_keyframes(track, traits);
    scans->odometry = odometry_from_scans(robot, track, params.stage);
    for (const std::size_t k : track.keyframes) scans->keyframe_stamps.push_back(track.poses[k].stamp);
    close_loops(measured, RobotIndex(r), *scans, loops, progress);
  }
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
