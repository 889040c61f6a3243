// Upright boxes and pillars, and their intersection with rays.
//
// Each shape is an intersection of slabs, between two planes or within a cylinder: a ray is inside it between
// the last slab that it enters and the first one that it leaves. Surfaces are two-sided, so a box also serves
// as a room. Common frame, metres; exact up to rounding.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace radioslam {

/// A half line from a point along a unit vector.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// First hit of a ray with a surface.
struct RayHit {
  double range_m = 0;
  Eigen::Vector3d normal;  ///< unit, towards the ray's origin
};

/// A house, a crate, or a wall if one of its sides is zero.
struct UprightBox {
  Eigen::Vector2d centre_m;
  Eigen::Vector2d forward = Eigen::Vector2d::UnitX();  ///< unit, along its first side
  Eigen::Vector2d half_size_m;                         ///< half of the first and the second side
  double bottom_m = 0;
  double top_m = 0;
};

/// A wall above the floor's segment between two points.
UprightBox wall_between(const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m, double bottom_m,
                        double top_m);

/// A round pillar.
struct UprightPillar {
  Eigen::Vector2d centre_m;
  double radius_m = 0;
  double bottom_m = 0;
  double top_m = 0;
};

/// The first hit ahead of the ray's origin.
std::optional<RayHit> ray_hit(const Ray& ray, const UprightBox& box);
std::optional<RayHit> ray_hit(const Ray& ray, const UprightPillar& pillar);

/// Bounding box of the shape on the floor.
Eigen::AlignedBox2d footprint(const UprightBox& box);
Eigen::AlignedBox2d footprint(const UprightPillar& pillar);

/// Distance on the floor from a place to the shape, 0 inside.
double floor_distance_m(const UprightBox& box, const Eigen::Vector2d& place);
double floor_distance_m(const UprightPillar& pillar, const Eigen::Vector2d& place);

/// Whether two boxes overlap or touch on the floor.
bool overlap(const UprightBox& a, const UprightBox& b);

}  // namespace radioslam
