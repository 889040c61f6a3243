// LiDAR(-inertial) odometry and intra-robot loop closures of all robots with laser scans.
//
// The scans' poses and their covariances are the robot's odometry. Recorded odometry initialises scan
// matching, deskews scans, and extends the odometry before, after and between them; an IMU does the first two
// better and constrains motion that the scans do not. The mission stays as it was recorded.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_front_end.hpp"
#include "radioslam/odometry/scan_params.hpp"
#include "radioslam/odometry/scan_tracking.hpp"
#include "radioslam/places/loops/scan_loop.hpp"
#include "radioslam/places/loops/scan_loops.hpp"

namespace radioslam {

// Intra-robot loop closure by scan matching, to be added to the joint graph as a factor.

/// Between scans that are keyframes.
struct ScanClosure {
  RobotIndex robot;
  Stamp stamp_i, stamp_j;
  ScanLoop loop;
};

/// What a robot's scans say of its motion, and the keyframes that other robots' scans can be compared with.
struct ScanOdometry {
  std::optional<MeasuredOdometry> odometry;  ///< nothing where it is used as recorded
  ScanKeyframes keyframes;                   ///< with their clouds
  std::vector<Stamp> keyframe_stamps;
  std::vector<SE3> corrected = {};  ///< keyframes.poses with the robot's loop closures; empty without any
  /// The first and the last scan, where the motion between scans is known by the robot's IMU.
  std::optional<std::pair<Stamp, Stamp>> by_imu = {};
};

struct MeasuredScans {
  /// Per robot; nothing without scans, or where its odometry is used as recorded and nothing else is asked.
  std::vector<std::optional<ScanOdometry>> robots;
  std::vector<ScanClosure> closures;
  std::vector<std::string> notes;
  std::size_t scans = 0, registered = 0;
  std::size_t too_few = 0, lost = 0;  ///< skipped: too few points; no match with the map
};

/// How a robot's loops are searched in a mission of so many dimensions.
ScanLoopSearch loop_search(const ScanParams& params, const PlaceDescriptorParams& descriptors, int dimension);

/// Whether a robot whose odometry is used as recorded gets keyframes with scans, too.
enum class ScansOfRecorded { kIgnored, kForPlaces };

/// `descriptors`: by which loop closures within a robot find places that look alike. `tracked`: per robot its
/// scans, where they have been tracked already.
MeasuredScans measure_scans(const Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress, ScansOfRecorded recorded = ScansOfRecorded::kIgnored,
                            const PlaceDescriptorParams& descriptors = {},
                            std::vector<std::optional<TrackedScans>> tracked = {});

/// The mission with the odometry of its scans, and with keyframes among which are those of the scans.
Mission with_odometry(Mission mission, const MeasuredScans& measured, const KeyframeParams& keyframes);

}  // namespace radioslam
