#include "radioslam/closure/overlap/overlap_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

using Eigen::Vector2d;

struct Segment {
  Vector2d from, to;
};

bool is_disc(const ViewSector& s) { return s.half_angle_rad >= std::numbers::pi; }

Vector2d corner(const ViewSector& s, double side) {
  const double angle = s.heading_rad + side * s.half_angle_rad;
  return s.apex_m + s.range_m * Vector2d(std::cos(angle), std::sin(angle));
}

/// The two straight sides of a sector that is not a disc.
std::array<Segment, 2> sides(const ViewSector& s) {
  return {{{s.apex_m, corner(s, -1)}, {s.apex_m, corner(s, 1)}}};
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Vector2d nearest_on(const Segment& s, const Vector2d& p) {
  const Vector2d along = s.to - s.from;
  const double squared = along.squaredNorm();
  const double fraction = squared > 0 ? std::clamp((p - s.from).dot(along) / squared, 0.0, 1.0) : 0.0;
  return s.from + fraction * along;
}

bool properly_cross(const Segment& a, const Segment& b) {
  const Vector2d u = a.to - a.from, v = b.to - b.from;
  return cross(u, b.from - a.from) * cross(u, b.to - a.from) < 0 &&
         cross(v, a.from - b.from) * cross(v, a.to - b.from) < 0;
}

double distance_to(const ViewSector& s, const Vector2d& p) {
  const Vector2d seen = p - s.apex_m;
  const double distance = seen.norm();
  if (is_disc(s) || distance == 0) return std::max(0.0, distance - s.range_m);
  const double off = wrap_angle(std::atan2(seen.y(), seen.x()) - s.heading_rad);
  if (std::abs(off) <= s.half_angle_rad) return std::max(0.0, distance - s.range_m);
  const auto [right, left] = sides(s);
  return std::min((p - nearest_on(right, p)).norm(), (p - nearest_on(left, p)).norm());
}

/// Point of a's arc on the ray from a's apex to `p`, if the ray crosses the arc.
std::optional<Vector2d> arc_towards(const ViewSector& a, const Vector2d& p) {
  const Vector2d to_p = p - a.apex_m;
  const double distance = to_p.norm();
  if (distance == 0) return std::nullopt;
  const double off = wrap_angle(std::atan2(to_p.y(), to_p.x()) - a.heading_rad);
  if (!is_disc(a) && std::abs(off) > a.half_angle_rad) return std::nullopt;
  return a.apex_m + a.range_m / distance * to_p;
}

/// Smallest distance from b to those points of a that can be nearest: its corners, the feet of b's apex on
/// its sides, and the point of its arc towards b's apex.
double distance_of_key_points(const ViewSector& a, const ViewSector& b) {
  double least = distance_to(b, a.apex_m);
  if (const auto on_arc = arc_towards(a, b.apex_m)) least = std::min(least, distance_to(b, *on_arc));
  if (is_disc(a)) return least;
  for (const Segment& side : sides(a)) {
    least = std::min(least, distance_to(b, side.to));
    least = std::min(least, distance_to(b, nearest_on(side, b.apex_m)));
  }
  return least;
}

}  // namespace

double sector_distance(const ViewSector& a, const ViewSector& b) {
  if (is_disc(a) && is_disc(b)) return std::max(0.0, (b.apex_m - a.apex_m).norm() - a.range_m - b.range_m);
  if (!is_disc(a) && !is_disc(b))
    for (const Segment& side_a : sides(a))
      for (const Segment& side_b : sides(b))
        if (properly_cross(side_a, side_b)) return 0;
  return std::min(distance_of_key_points(a, b), distance_of_key_points(b, a));
}

}  // namespace radioslam
