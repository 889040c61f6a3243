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
  double bend_m = 0.05;                    ///< off the geodesic between two keyframes; 0: any
  double bend_rad = 0.02;                  ///< likewise

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"distance_m", "m", 0.01, 1000, "a keyframe at least this far from the last one"},
          self.distance_m);
    visit(Field{"angle_rad", "rad", 0.001, 10, "or turned by at least this much from it"}, self.angle_rad);
    visit(Field{"bend_m", "m", 0, 1000,
                "where scans made the odometry: or this far from where two keyframes have it; 0: not"},
          self.bend_m);
    visit(Field{"bend_rad", "rad", 0, 10, "or turned by so much against it; 0: not"}, self.bend_rad);
  }
};

/// Is a pose at least `distance_m` or `angle_rad` from the last keyframe?
bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params);

/// Indices of the odometry rows at least `distance_m` or `angle_rad` from the last keyframe, and of the
/// first and the last row.
std::vector<std::size_t> select_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params);

/// `keyframes` and rows between them, the worst first, until no row is further than
/// `bend_m` or `bend_rad` from the geodesic between its neighbours (Douglas and Peucker 1973, over time).
std::vector<std::size_t> with_bends(const Trajectory<SE3>& odometry,
                                    const std::vector<std::size_t>& keyframes, const KeyframeParams& params);

/// Index of the last keyframe at or before `stamp`; 0 before the first.
std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp);

}  // namespace radioslam
