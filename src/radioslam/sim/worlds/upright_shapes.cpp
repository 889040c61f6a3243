#include "radioslam/sim/worlds/upright_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace radioslam {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The interval of a ray within a slab.
struct RayInterval {
  double enter_m = -kFar;
  double leave_m = kFar;
};

constexpr RayInterval kNowhere{kFar, -kFar};

/// Interval between two parallel planes, by a ray's coordinate across them.
RayInterval between_planes(double origin, double direction, double low, double high) {
  if (direction == 0) return origin >= low && origin <= high ? RayInterval{} : kNowhere;
  const double a = (low - origin) / direction, b = (high - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

/// Interval within a circle of the floor around the origin.
RayInterval within_circle(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double radius_m) {
  const double square = direction.squaredNorm();
  if (square == 0) return origin.norm() <= radius_m ? RayInterval{} : kNowhere;
  const double nearest = -origin.dot(direction) / square;
  const double aside_squared = (origin + nearest * direction).squaredNorm();
  if (aside_squared > radius_m * radius_m) return kNowhere;
  const double half = std::sqrt((radius_m * radius_m - aside_squared) / square);
  return {nearest - half, nearest + half};
}

/// The slab whose surface a ray hits, and where.
struct SlabHit {
  double range_m = 0;
  int slab = 0;
};

/// First surface ahead of the intersection of these slabs.
template <std::size_t Slabs>
std::optional<SlabHit> first_surface(const std::array<RayInterval, Slabs>& slabs) {
  SlabHit enter{-kFar, 0}, leave{kFar, 0};
  for (int k = 0; k < static_cast<int>(Slabs); ++k) {
    const RayInterval& slab = slabs[static_cast<std::size_t>(k)];
    if (slab.enter_m > enter.range_m) enter = {slab.enter_m, k};
    if (slab.leave_m < leave.range_m) leave = {slab.leave_m, k};
  }
  if (enter.range_m > leave.range_m || leave.range_m <= 0) return std::nullopt;
  return enter.range_m > 0 ? enter : leave;
}

/// Hit with the normal on the side of the ray's origin.
RayHit facing(double range_m, const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) {
  return {range_m, normal.dot(direction) > 0 ? Eigen::Vector3d(-normal) : normal};
}

Eigen::Vector3d level(const Eigen::Vector2d& v) { return {v.x(), v.y(), 0}; }

Eigen::Vector2d left_of(const Eigen::Vector2d& forward) { return {-forward.y(), forward.x()}; }

/// Half of the box's size on the floor along a unit vector.
double half_size_along_m(const UprightBox& box, const Eigen::Vector2d& axis) {
  return box.half_size_m.x() * std::abs(box.forward.dot(axis)) +
         box.half_size_m.y() * std::abs(left_of(box.forward).dot(axis));
}

}  // namespace

UprightBox wall_between(const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m, double bottom_m,
                        double top_m) {
  const Eigen::Vector2d along = end_m - begin_m;
  return {0.5 * (begin_m + end_m), along.normalized(), {0.5 * along.norm(), 0}, bottom_m, top_m};
}

std::optional<RayHit> ray_hit(const Ray& ray, const UprightBox& box) {
  const Eigen::Vector2d place = ray.origin.head<2>() - box.centre_m, way = ray.direction.head<2>();
  const Eigen::Vector2d left = left_of(box.forward);
  const Eigen::Vector2d& half = box.half_size_m;
  const auto hit =
      first_surface<3>({between_planes(place.dot(box.forward), way.dot(box.forward), -half.x(), half.x()),
                        between_planes(place.dot(left), way.dot(left), -half.y(), half.y()),
                        between_planes(ray.origin.z(), ray.direction.z(), box.bottom_m, box.top_m)});
  if (!hit) return std::nullopt;
  const Eigen::Vector3d normal =
      hit->slab == 2 ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : level(hit->slab == 0 ? box.forward : left);
  return facing(hit->range_m, normal, ray.direction);
}

std::optional<RayHit> ray_hit(const Ray& ray, const UprightPillar& pillar) {
  const Eigen::Vector2d place = ray.origin.head<2>() - pillar.centre_m, way = ray.direction.head<2>();
  const auto hit =
      first_surface<2>({within_circle(place, way, pillar.radius_m),
                        between_planes(ray.origin.z(), ray.direction.z(), pillar.bottom_m, pillar.top_m)});
  if (!hit) return std::nullopt;
  const Eigen::Vector2d outward = (place + hit->range_m * way) / pillar.radius_m;
  return facing(hit->range_m, hit->slab == 1 ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : level(outward),
                ray.direction);
}

Eigen::AlignedBox2d footprint(const UprightBox& box) {
  const Eigen::Vector2d reach =
      box.half_size_m.x() * box.forward.cwiseAbs() + box.half_size_m.y() * left_of(box.forward).cwiseAbs();
  return {Eigen::Vector2d(box.centre_m - reach), Eigen::Vector2d(box.centre_m + reach)};
}

Eigen::AlignedBox2d footprint(const UprightPillar& pillar) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(pillar.radius_m);
  return {Eigen::Vector2d(pillar.centre_m - reach), Eigen::Vector2d(pillar.centre_m + reach)};
}

double floor_distance_m(const UprightBox& box, const Eigen::Vector2d& place) {
  const Eigen::Vector2d offset = place - box.centre_m;
  const Eigen::Vector2d across(offset.dot(box.forward), offset.dot(left_of(box.forward)));
  return (across.cwiseAbs() - box.half_size_m).cwiseMax(0).norm();
}

double floor_distance_m(const UprightPillar& pillar, const Eigen::Vector2d& place) {
  return std::max(0.0, (place - pillar.centre_m).norm() - pillar.radius_m);
}

bool overlap(const UprightBox& a, const UprightBox& b) {
  const Eigen::Vector2d offset = b.centre_m - a.centre_m;
  const std::array axes{a.forward, left_of(a.forward), b.forward, left_of(b.forward)};
  return std::all_of(axes.begin(), axes.end(), [&](const Eigen::Vector2d& axis) {
    return std::abs(offset.dot(axis)) <= half_size_along_m(a, axis) + half_size_along_m(b, axis);
  });
}

}  // namespace radioslam
