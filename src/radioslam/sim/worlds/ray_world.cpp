#include "radioslam/sim/worlds/ray_world.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {
namespace {

std::vector<Eigen::AlignedBox2d> footprints_of(const WorldShapes& shapes) {
  std::vector<Eigen::AlignedBox2d> footprints;
  for (const auto& box : shapes.boxes) footprints.push_back(footprint(box));
  for (const auto& pillar : shapes.pillars) footprints.push_back(footprint(pillar));
  return footprints;
}

}  // namespace

RayWorld::RayWorld(WorldShapes shapes) : shapes_(std::move(shapes)), grid_(footprints_of(shapes_)) {}

std::optional<RayHit> RayWorld::cast(const Ray& ray, double max_m) const {
  std::optional<RayHit> nearest = cast_at_ground(ray, max_m);
  const auto keep_nearer = [&](std::optional<RayHit> hit) {
    if (hit && hit->range_m <= (nearest ? nearest->range_m : max_m)) nearest = hit;
  };
  keep_nearer(cast_at_ceiling(ray, max_m));
  FloorGrid::Walk walk(grid_, ray.origin.head<2>(), ray.direction.head<2>(),
                       nearest ? nearest->range_m : max_m);
  for (; !walk.over(); walk.go_on()) {
    for (const std::uint32_t shape : walk.shapes()) keep_nearer(cast_at_shape(ray, shape));
    if (nearest && nearest->range_m <= walk.leaves()) break;
  }
  return nearest;
}

std::optional<RayHit> RayWorld::cast_at_ground(const Ray& ray, double max_m) const {
  const auto range_m = shapes_.ground.ray_m(ray.origin, ray.direction, max_m);
  if (!range_m) return std::nullopt;
  const Eigen::Vector2d slope = shapes_.ground.gradient((ray.origin + *range_m * ray.direction).head<2>());
  return RayHit{*range_m, Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized()};
}

std::optional<RayHit> RayWorld::cast_at_ceiling(const Ray& ray, double max_m) const {
  if (!shapes_.ceiling_m || ray.direction.z() <= 0) return std::nullopt;
  const double range_m = (*shapes_.ceiling_m - ray.origin.z()) / ray.direction.z();
  if (range_m <= 0 || range_m > max_m) return std::nullopt;
  return RayHit{range_m, -Eigen::Vector3d::UnitZ()};
}

std::optional<RayHit> RayWorld::cast_at_shape(const Ray& ray, std::size_t shape) const {
  const std::size_t boxes = shapes_.boxes.size();
  return shape < boxes ? ray_hit(ray, shapes_.boxes[shape]) : ray_hit(ray, shapes_.pillars[shape - boxes]);
}

}  // namespace radioslam
