// Whether two robots' scans can be of one world, laid over each other: what one robot hit must not lie where
// the other looked through.
//
// Of one keyframe's scan, the panorama keeps the ranges in every direction. A point of the other robot is
//   seen            if a return near its direction is as far,
//   seen through    if all returns around its direction are farther,
// and otherwise hidden or out of view, which is no evidence. A scan fits a wrong place that looks alike; the
// scans of a whole trajectory do not, unless the world repeats itself as a whole.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/places/keyframe_contexts.hpp"
#include "radioslam/places/loops/expected_place.hpp"

namespace radioslam {

/// Ranges of a scan by direction.
class Panorama {
 public:
  enum class View { kNothing, kSeen, kThrough };

  explicit Panorama(const ScanPyramid& scan, ScannerKind kind);

  /// Of a point in the scan's body frame that is known to `tolerance_m`.
  View of(const Eigen::Vector3f& point, float tolerance_m) const;

 private:
  struct Direction {
    int column, row;
    float range_m;
  };
  Direction direction(const Eigen::Vector3f& point) const;

  ScannerKind kind_;
  float reach_m_ = 0;                         ///< of most returns
  std::vector<std::vector<float>> ranges_m_;  ///< per direction
};

/// A keyframe of each robot whose relative pose is known.
struct SharedPlace {
  std::size_t i = 0, j = 0;
  SE3 T_i_j;
  double sigma_m = 0;
};

/// Points of structure, once for each keyframe of the other robot that may see them.
struct SeenThrough {
  std::size_t seen = 0, through = 0;

  std::size_t all() const { return seen + through; }
  double share() const { return all() == 0 ? 0 : static_cast<double>(through) / static_cast<double>(all()); }
};

/// Both robots' points in the other's views. Keyframes are placed from the nearest shared place along the
/// trajectories by odometry, and left out where it does not constrain them well. `places` must not be empty.
SeenThrough seen_through(const PlacedKeyframes& a, const PlacedKeyframes& b,
                         const std::vector<SharedPlace>& places);

}  // namespace radioslam
