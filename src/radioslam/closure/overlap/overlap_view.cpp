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

/// Rays per view for the common area of two sectors.
constexpr double kRays = 256, kFewRays = 24;
/// More than the error of a share by few rays.
constexpr double kCertain = 0.05;
/// Relative accuracy of a largest distance.
constexpr double kDistanceAccuracy = 1e-12;

struct Segment {
  Vector2d from, to;
};

bool is_disc(const ViewSector& s) { return s.half_angle_rad >= std::numbers::pi; }

Vector2d direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

Vector2d corner(const ViewSector& s, double side) {
  return s.apex_m + s.range_m * direction(s.heading_rad + side * s.half_angle_rad);
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

double area_m2(const ViewSector& s) {
  return std::min(s.half_angle_rad, std::numbers::pi) * s.range_m * s.range_m;
}

/// Area between the arc and the chord of a disc, by the cosine of half the arc's angle.
double segment_area_m2(double range_m, double cosine) {
  const double half_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  return range_m * range_m * (half_rad - std::sin(half_rad) * std::cos(half_rad));
}

/// Common area of two discs at distance d.
double lens_area_m2(double range_a_m, double range_b_m, double d) {
  const double a = range_a_m, b = range_b_m;
  if (d >= a + b) return 0;
  if (d <= std::abs(a - b)) return std::numbers::pi * std::min(a, b) * std::min(a, b);
  const double excess = (a - b) * (a + b) / d;
  return segment_area_m2(a, (d + excess) / (2 * a)) + segment_area_m2(b, (d - excess) / (2 * b));
}

struct Ray {
  Vector2d from, direction;
  double length_m = 0;
};

/// Part of a ray; empty unless from < to.
struct Stretch {
  double from = 0, to = 0;

  bool empty() const { return !(from < to); }
  /// Its points with value + slope * distance >= 0.
  Stretch where_positive(double value, double slope) const {
    if (slope > 0) return {std::max(from, -value / slope), to};
    if (slope < 0) return {from, std::min(to, -value / slope)};
    return value < 0 ? Stretch{} : *this;
  }
};

/// The shortest stretch with both.
Stretch hull(const Stretch& a, const Stretch& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.from, b.from), std::max(a.to, b.to)};
}

Stretch within_disc(const Ray& ray, const Vector2d& centre, double radius_m) {
  const Vector2d to_centre = centre - ray.from;
  const double along = to_centre.dot(ray.direction), across = cross(ray.direction, to_centre);
  const double half = std::sqrt(std::max(0.0, radius_m * radius_m - across * across));
  return {std::max(0.0, along - half), std::min(ray.length_m, along + half)};
}

/// Within `margin_m` of a segment; convex, hence one stretch.
Stretch near_segment(const Ray& ray, const Segment& s, double margin_m) {
  const double length = (s.to - s.from).norm();
  const Vector2d v = (s.to - s.from) / length, offset = ray.from - s.from;
  const double along = v.dot(offset), along_slope = v.dot(ray.direction);
  const double across = cross(v, offset), across_slope = cross(v, ray.direction);
  const Stretch beside = Stretch{0, ray.length_m}
                             .where_positive(along, along_slope)
                             .where_positive(length - along, -along_slope)
                             .where_positive(margin_m + across, across_slope)
                             .where_positive(margin_m - across, -across_slope);
  return hull(hull(beside, within_disc(ray, s.from, margin_m)), within_disc(ray, s.to, margin_m));
}

/// A sector and all points within `margin_m` of it, as seen along rays.
class DilatedSector {
 public:
  DilatedSector(const ViewSector& sector, double margin_m)
      : sector_(sector), margin_m_(margin_m), is_disc_(is_disc(sector)) {
    if (is_disc_) return;
    sides_ = sides(sector);
    right_ = direction(sector.heading_rad - sector.half_angle_rad);
    left_ = direction(sector.heading_rad + sector.half_angle_rad);
  }

  /// Area that the ray's part in it sweeps per radian as the ray turns about its origin.
  double swept_m2(const Ray& ray) const {
    std::array<Stretch, 4> parts = stretches(ray);
    std::sort(parts.begin(), parts.end(), [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
    double sum = 0, reached = 0;
    for (const Stretch& part : parts) {
      const double from = std::max(part.from, reached);
      if (part.to <= from) continue;
      reached = part.to;
      sum += (reached * reached - from * from) / 2;
    }
    return sum;
  }

 private:
  /// Up to four, which may overlap.
  std::array<Stretch, 4> stretches(const Ray& ray) const {
    const Stretch in_disc = within_disc(ray, sector_.apex_m, sector_.range_m + margin_m_);
    if (is_disc_) return {in_disc};
    const Vector2d offset = ray.from - sector_.apex_m;
    const auto left_of_right = [&](const Stretch& s) {
      return s.where_positive(cross(right_, offset), cross(right_, ray.direction));
    };
    const auto right_of_left = [&](const Stretch& s) {
      return s.where_positive(cross(offset, left_), cross(ray.direction, left_));
    };
    std::array<Stretch, 4> parts;
    if (sector_.half_angle_rad <= std::numbers::pi / 2)
      parts = {right_of_left(left_of_right(in_disc))};
    else
      parts = {left_of_right(in_disc), right_of_left(in_disc)};
    if (margin_m_ > 0)
      for (std::size_t i = 0; i < 2; ++i) parts[2 + i] = near_segment(ray, sides_[i], margin_m_);
    return parts;
  }

  ViewSector sector_;
  double margin_m_;
  bool is_disc_;
  std::array<Segment, 2> sides_;
  Vector2d right_, left_;  ///< along the sides
};

/// Common area of a sector and a dilated one: the midpoint rule over rays from a's apex, between the
/// directions of b's apex and corners, where the part of a ray that is in b may change at once.
double common_area_m2(const ViewSector& a, const ViewSector& b, double margin_m, double rays_per_view) {
  const double half = std::min(a.half_angle_rad, std::numbers::pi);
  std::array<double, 5> cuts{-half, half, half, half, half};
  if (!is_disc(b)) {
    const std::array<Vector2d, 3> points{b.apex_m, corner(b, -1), corner(b, 1)};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d seen = points[i] - a.apex_m;
      cuts[i + 1] = std::clamp(wrap_angle(std::atan2(seen.y(), seen.x()) - a.heading_rad), -half, half);
    }
    std::sort(cuts.begin(), cuts.end());
  }
  const DilatedSector of_b(b, margin_m);
  double area = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double width = cuts[i + 1] - cuts[i];
    const int rays = static_cast<int>(std::ceil(rays_per_view * width / (2 * half)));
    for (int k = 0; k < rays; ++k) {
      const double angle = a.heading_rad + cuts[i] + width * (k + 0.5) / rays;
      area += width / rays * of_b.swept_m2({a.apex_m, direction(angle), a.range_m});
    }
  }
  return area;
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

double shared_view(const ViewSector& a, const ViewSector& b) { return max_shared_view(a, b, 0, 0); }

namespace {

double max_shared_view(const ViewSector& a, const ViewSector& b, double offset_m, double turn_rad,
                       double rays) {
  const double area_a = area_m2(a), area_b = area_m2(b);
  if (!(std::min(area_a, area_b) > 0)) return 0;
  ViewSector turned = b;
  turned.half_angle_rad += turn_rad;
  double common = 0;
  if (is_disc(a) && is_disc(turned))
    common = lens_area_m2(a.range_m, b.range_m, std::max(0.0, (b.apex_m - a.apex_m).norm() - offset_m));
  else
    common = common_area_m2(a, turned, offset_m, rays);
  common = std::min({common, area_a, area_b});
  return common / (area_a + area_b - common);
}

}  // namespace

double max_shared_view(const ViewSector& a, const ViewSector& b, double offset_m, double turn_rad) {
  return max_shared_view(a, b, offset_m, turn_rad, kRays);
}

bool can_share_view(const ViewSector& a, const ViewSector& b, double offset_m, double turn_rad,
                    double min_shared_view) {
  const double roughly = max_shared_view(a, b, offset_m, turn_rad, kFewRays) - min_shared_view;
  if (std::abs(roughly) > kCertain) return roughly > 0;
  return max_shared_view(a, b, offset_m, turn_rad) >= min_shared_view;
}

std::optional<double> max_distance_of_shared_view(double range_a_m, double range_b_m,
                                                  double min_shared_view) {
  return max_distance_of_shared_view(OverlapSensor{range_a_m}, OverlapSensor{range_b_m}, min_shared_view);
}

std::optional<double> max_distance_of_shared_view(const OverlapSensor& a, const OverlapSensor& b,
                                                  double min_shared_view) {
  double far = a.range_m + b.range_m;
  if (min_shared_view <= 0) return far;
  const double area_a = area_m2({{}, 0, a.view_rad / 2, a.range_m});
  const double area_b = area_m2({{}, 0, b.view_rad / 2, b.range_m});
  const double smaller = std::min(area_a, area_b), larger = std::max(area_a, area_b);
  if (!(smaller > 0 && smaller >= min_shared_view * larger)) return std::nullopt;
  const double common = min_shared_view / (1 + min_shared_view) * (area_a + area_b);
  double near = std::abs(a.range_m - b.range_m);
  const double accuracy = kDistanceAccuracy * far;
  while (far - near > accuracy) {
    const double middle = (near + far) / 2;
    (lens_area_m2(a.range_m, b.range_m, middle) >= common ? near : far) = middle;
  }
  return near;
}

}  // namespace radioslam
