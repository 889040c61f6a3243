// Boxes and pillars that stand upright, and where rays meet them.
//
// Each shape is convex: a set of slabs, between two planes or within a cylinder. A ray is inside the shape
// between the last slab that it enters and the first one that it leaves. Surfaces are seen from both sides,
// so a box is also a room. Everything in the common frame, metres; exact up to rounding.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace radioslam {

/// A straight line from a place, along a unit vector.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// Where a ray meets a surface first.
struct RayHit {
  double range_m = 0;
  Eigen::Vector3d normal;  ///< unit, towards the side from which the ray comes
};

/// A house, a crate, or, where one of its sides is zero, a wall.
struct UprightBox {
  Eigen::Vector2d centre_m;
  Eigen::Vector2d forward = Eigen::Vector2d::UnitX();  ///< unit, along its first side
  Eigen::Vector2d half_size_m;                         ///< half of the first and the second side
  double bottom_m = 0;
  double top_m = 0;
};

/// The wall over the floor's segment between two places.
UprightBox wall_between(const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m, double bottom_m,
                        double top_m);

/// A round pillar.
struct UprightPillar {
  Eigen::Vector2d centre_m;
  double radius_m = 0;
  double bottom_m = 0;
  double top_m = 0;
};

/// The first place ahead of the ray's origin.
std::optional<RayHit> ray_hit(const Ray& ray, const UprightBox& box);
std::optional<RayHit> ray_hit(const Ray& ray, const UprightPillar& pillar);

/// What it covers of the floor, at most.
Eigen::AlignedBox2d footprint(const UprightBox& box);
Eigen::AlignedBox2d footprint(const UprightPillar& pillar);

}  // namespace radioslam
