#include "radioslam/sim/sensors/image_sources.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace radioslam {
namespace {

constexpr double kNearest_m =
    0.05;                        ///< lower bound on antenna distances: below, the far field's 1 / d is wrong
constexpr double kTouch = 1e-6;  ///< ratio of a leg at its ends within which it does not cross a wall

using Bounces = std::vector<const WallSegment*>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Eigen::Vector2d mirrored(const Eigen::Vector2d& point, const WallSegment& wall) {
  const Eigen::Vector2d along = (wall.end_m - wall.begin_m).normalized();
  const Eigen::Vector2d from_begin = point - wall.begin_m;
  return wall.begin_m + 2 * along.dot(from_begin) * along - from_begin;
}

double gain_of_db(double db) { return std::pow(10, db / 20); }

/// Amplitude ratio after the walls that a leg crosses.
double gain_through(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                    const std::vector<WallSegment>& walls) {
  double loss_db = 0;
  for (const WallSegment& wall : walls)
    if (crossing(from, to, wall)) loss_db += wall.loss_db;
  return gain_of_db(-loss_db);
}

/// The path reflected by these walls, the transmitter's first; nothing if a bounce misses its wall.
std::optional<RadioPath> trace(const Eigen::Vector3d& transmitter_m, const Eigen::Vector3d& receiver_m,
                               const std::vector<WallSegment>& walls, const Bounces& bounces) {
  std::vector<Eigen::Vector2d> images{transmitter_m.head<2>()};
  for (const WallSegment* wall : bounces) images.push_back(mirrored(images.back(), *wall));

  RadioPath path;
  path.bounces = static_cast<int>(bounces.size());
  path.amplitude = 1;
  Eigen::Vector2d here = receiver_m.head<2>();
  for (std::size_t k = bounces.size(); k > 0; --k) {  // back from the receiver
    const auto ratio = crossing(here, images[k], *bounces[k - 1]);
    if (!ratio) return std::nullopt;
    const Eigen::Vector2d bounce = here + *ratio * (images[k] - here);
    path.amplitude *= bounces[k - 1]->reflection * gain_through(here, bounce, walls);
    here = bounce;
  }
  path.amplitude *= gain_through(here, images.front(), walls);

  const Eigen::Vector3d last_image(images.back().x(), images.back().y(), transmitter_m.z());
  path.length_m = std::max((last_image - receiver_m).norm(), kNearest_m);
  path.amplitude /= path.length_m;
  path.direction = (last_image - receiver_m).normalized();
  return path;
}

}  // namespace

std::optional<double> crossing(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               const WallSegment& wall) {
  const Eigen::Vector2d leg = to - from, along = wall.end_m - wall.begin_m, between = wall.begin_m - from;
  const double area = cross(leg, along);
  if (area == 0) return std::nullopt;
  const double ratio = cross(between, along) / area, along_ratio = cross(between, leg) / area;
  const bool on_both = ratio > kTouch && ratio < 1 - kTouch && along_ratio >= 0 && along_ratio <= 1;
  return on_both ? std::optional(ratio) : std::nullopt;
}

double WallSegment::distance_m(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d along = end_m - begin_m;
  const double ratio = std::clamp((point - begin_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (begin_m + ratio * along - point).norm();
}

std::vector<RadioPath> image_paths(const Eigen::Vector3d& transmitter_m, const Eigen::Vector3d& receiver_m,
                                   const std::vector<WallSegment>& walls, const ImageParams& params) {
  std::vector<RadioPath> paths;
  const auto add = [&](const Bounces& bounces) {
    if (const auto path = trace(transmitter_m, receiver_m, walls, bounces)) paths.push_back(*path);
  };
  add({});
  paths.front().amplitude *= gain_of_db(-params.obstruction_db);
  if (params.max_bounces >= 1)
    for (const WallSegment& wall : walls) add({&wall});
  if (params.max_bounces >= 2)
    for (const WallSegment& first : walls)
      for (const WallSegment& second : walls)
        if (&first != &second) add({&first, &second});
  return paths;
}

}  // namespace radioslam
