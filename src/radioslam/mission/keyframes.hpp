// Keyframe selection: which odometry samples become variables of the joint estimate.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

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
                    "deviation of LiDAR odometry from the interpolation between keyframes beyond which a "
                    "keyframe is added; 0: off");
    RADIOSLAM_FIELD(max_deviation_rad, "rad", 0, 10,
                    "angular deviation of LiDAR odometry from the interpolation between keyframes beyond "
                    "which one is added; 0: off");
  }
};

/// Whether a pose is at least `distance_m` or `angle_rad` from the last keyframe.
bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params);

/// Indices of the first and the last odometry sample, and of those at least `distance_m` or `angle_rad` from
/// the last keyframe.
std::vector<std::size_t> select_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params);

/// Adds odometry samples to `keyframes`, the worst first, until none deviates by more than `max_deviation_m`
/// or `max_deviation_rad` from the geodesic between its neighbouring keyframes (Douglas and Peucker 1973,
/// over time).
std::vector<std::size_t> refined_keyframes(const Trajectory<SE3>& odometry,
                                           const std::vector<std::size_t>& keyframes,
                                           const KeyframeParams& params);

/// Keyframes as a robot on its way chooses them, without knowledge of what comes: the first and the last
/// sample, those at least `distance_m` or `angle_rad` from the last keyframe, and the last one before a
/// sample to which the geodesic would be off by more than `max_deviation_m` or `max_deviation_rad`.
std::vector<std::size_t> causal_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params);

/// Index of the last keyframe at or before `stamp`; 0 before the first.
std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp);

}  // namespace radioslam
