// Keyframe selection: at which times a robot's poses become variables of the joint estimate.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct KeyframeParams {
  double distance_m = 1;
  double angle_rad = 0.17453292519943295;
  double max_deviation_m = 0.05;
  double max_deviation_rad = 0.02;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(
        distance_m, "m", 0.01, 1000,
        "distance from the last keyframe at which a new one is added; lower values add more keyframes");
    RADIOSLAM_BASIC_FIELD(
        angle_rad, "rad", 0.001, 10,
        "rotation from the last keyframe at which a new one is added; lower values add more keyframes");
    RADIOSLAM_FIELD(max_deviation_m, "m", 0, 1000,
                    "deviation of the odometry from the interpolation between keyframes beyond which one is "
                    "added; 0: off");
    RADIOSLAM_FIELD(max_deviation_rad, "rad", 0, 10,
                    "angular deviation of the odometry from the interpolation between keyframes beyond which "
                    "one is added; 0: off");
  }
};

/// Whether a pose is at least `distance_m` or `angle_rad` from the last keyframe.
bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params);

/// Keyframes as the robot chooses them on its way, without knowledge of what comes: the first and the last
/// sample of the odometry; those at least `distance_m` or `angle_rad` from the last keyframe; the last one
/// before a sample to which the geodesic would be off by more than `max_deviation_m` or `max_deviation_rad`;
/// the times of measurements that are better than the odometry since the last keyframe, and those `given`.
std::vector<Stamp> choose_keyframes(const Mission& mission, RobotIndex robot, const KeyframeParams& params,
                                    const std::vector<Stamp>& given = {});

/// Those that the robot comes with, or else as chosen above.
std::vector<Stamp> keyframes_of(const Mission& mission, RobotIndex robot, const KeyframeParams& params);

/// A robot's keyframes in its odometry.
struct RobotNodes {
  Trajectory<SE3> odometry;       ///< the recorded samples, and one per keyframe in between
  std::vector<std::size_t> rows;  ///< of the keyframes, increasing
  std::vector<Stamp> stamps;      ///< of the keyframes
};

/// Nodes at these stamps, which increase and which the odometry covers.
RobotNodes nodes_at(const Trajectory<SE3>& odometry, std::vector<Stamp> keyframes);

/// Index of the last keyframe at or before `stamp`; 0 before the first.
std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp);

}  // namespace radioslam
