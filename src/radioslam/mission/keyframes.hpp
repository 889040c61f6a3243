// Which odometry rows become variables of the joint estimate.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

struct KeyframeParams {
  double distance_m = 1;                   ///< way from the last keyframe, straight
  double angle_rad = 0.17453292519943295;  ///< turn from the last keyframe; 10 degrees

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"distance_m", "m", 0.01, 1000, "a keyframe at least this far from the last one"},
          self.distance_m);
    visit(Field{"angle_rad", "rad", 0.001, 10, "or turned by at least this much from it"}, self.angle_rad);
  }
};

/// Is a pose at least `distance_m` or `angle_rad` from the last keyframe?
bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params);

/// Indices of the odometry rows at least `distance_m` or `angle_rad` from the last keyframe, and of the
/// first and the last row.
std::vector<std::size_t> select_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params);

/// Index of the last keyframe at or before `stamp`; 0 before the first.
std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp);

}  // namespace radioslam
