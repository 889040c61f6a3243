// What a scan says of points of a map: whether its rays end at them or go through.
//
// At a point p with normal n, a ray from o to its return h counts if it meets the point's surface, the disc
// of a given radius about p that is perpendicular to n:
//
//   hit        h is within `depth_m` of the plane of the disc, and above the disc
//   through    h is more than `depth_m` and a tenth of its distance from p behind the plane, and the ray
//              crosses the disc
//
// A ray that ends in front of the plane, or grazes it, counts for neither. Depth is measured along the
// normal, not along the ray: a floor that is seen at a grazing angle would else be seen through in front of
// every return. Without a normal the disc faces the ray. Rays are found by their direction. As a sweep takes
// time, a direction is looked up from where the scanner was when it looked there. Cost: a few dozen rays per
// point.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "radioslam/map/placed_scan.hpp"

namespace radioslam {

class RayView {
 public:
  RayView(const PlacedScan& scan, const MappedRobot& robot, double view_range_m);

  /// Where the scanner was in the middle of the sweep, in the frame.
  const Eigen::Vector3d& scanner() const { return origin_m_; }

  struct Votes {
    int hits = 0, through = 0;
  };
  /// `position` and `normal` in the frame; a normal of zero is unknown. `radius_m`: of the disc.
  Votes at(const Eigen::Vector3d& position, const Eigen::Vector3f& normal, float radius_m,
           float depth_m) const;

 private:
  struct Ray {
    Eigen::Vector3f origin, hit;  ///< relative to origin_m_
  };
  void sort_rays(const std::vector<Ray>& rays);
  void note_farthest(int column, int row, float range_m);

  double view_range_m_;
  Eigen::Vector3d origin_m_;
  std::vector<Eigen::Vector3f> column_origins_;  ///< where the scanner was when it looked there
  std::vector<float> farthest_m_;                ///< that rays about the pixels of a block reach, by block
  std::vector<Ray> rays_;                        ///< by pixel
  std::vector<std::uint32_t> begin_;             ///< of each pixel's rays, then the end
};

}  // namespace radioslam
