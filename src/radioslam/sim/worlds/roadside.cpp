#include "radioslam/sim/worlds/roadside.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "radioslam/base/check.hpp"
#include "radioslam/sim/worlds/path_ground.hpp"

namespace radioslam {
namespace {

constexpr double kSpacing_m = 1;      ///< of the path's places, seen from above
constexpr double kFoundation_m = 10;  ///< depth of houses and trees below the lowest place
constexpr double kNearby_m = 15;      ///< of a house: further away than the nearest passage

/// A house without room is pushed away from the path, at most so often and so far; if that does not help,
/// another one is tried further along the path.
constexpr int kMaxPushes = 3;
constexpr double kMaxPush_m = 6;
constexpr double kPushedFurther_m = 0.01;  ///< than is lacking
constexpr double kRetry_m = 2;

/// In widths of the street, from the path.
constexpr double kTreeNearest = 0.35, kTreeFurthest = 0.65, kTreeClearance = 0.3;
constexpr double kTreeMinRadius_m = 0.1, kTreeMaxRadius_m = 0.4;
constexpr double kTreeMinHeight_m = 4, kTreeMaxHeight_m = 9;

using Path = std::vector<Eigen::Vector3d>;

/// Equally distant places along the path.
Path places_along(const Path& path) {
  Path places{path.front()};
  double next_m = kSpacing_m;  // from path[k - 1]
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Eigen::Vector3d way = path[k] - path[k - 1];
    const double length_m = way.head<2>().norm();
    while (next_m <= length_m) {
      places.push_back(path[k - 1] + next_m / length_m * way);
      next_m += kSpacing_m;
    }
    next_m -= length_m;
  }
  return places;
}

double draw_m(double min_m, double max_m, Rng& rng) { return rng.uniform(min_m, std::max(min_m, max_m)); }

template <class Shape>
double distance_m(const Path& path, const Shape& shape) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& place : path) nearest_m = std::min(nearest_m, floor_distance_m(shape, place.head<2>()));
  return nearest_m;
}

/// Height of the highest place that is not much further away from a shape than the nearest.
template <class Shape>
double highest_nearby_m(const Path& path, const Shape& shape) {
  const double within_m = distance_m(path, shape) + kNearby_m;
  double highest_m = -std::numeric_limits<double>::infinity();
  for (const auto& place : path)
    if (floor_distance_m(shape, place.head<2>()) <= within_m) highest_m = std::max(highest_m, place.z());
  return highest_m;
}

/// One side of a path.
class Side {
 public:
  enum Direction { kLeft = 1, kRight = -1 };

  /// Of equally distant places along a path; `path` has all its places.
  Side(const Path& places, const Path& path, Direction direction, const RoadsideParams& params)
      : places_(places), path_(path), direction_(direction), params_(params) {
    for (const auto& place : path) bottom_m_ = std::min(bottom_m_, place.z() - kFoundation_m);
  }

  void add_houses(std::vector<UprightBox>& houses, Rng rng) const {
    const TownHouseParams& sizes = params_.houses;
    double next_m = 0;
    while (next_m < length_m()) {
      const Eigen::Vector2d size(draw_m(sizes.house_min_m, sizes.house_max_m, rng),
                                 draw_m(sizes.house_min_m, sizes.house_max_m, rng));
      const double setback_m = rng.uniform(0, sizes.house_setback_m);
      const double height_m = draw_m(sizes.house_min_height_m, sizes.house_max_height_m, rng);
      const double gap_m = rng.uniform(0, sizes.house_gap_m);
      const auto house = house_at(next_m, size, setback_m, height_m);
      const auto overlaps = [&](const UprightBox& other) { return overlap(*house, other); };
      const bool stands = house && std::none_of(houses.begin(), houses.end(), overlaps);
      if (stands) houses.push_back(*house);
      next_m += stands ? size.x() + gap_m : kRetry_m;
    }
  }

  void add_trees(const std::vector<UprightBox>& houses, std::vector<UprightPillar>& trees, Rng rng) const {
    const double street_m = params_.houses.street_width_m;
    double next_m = 0;
    while ((next_m += params_.tree_spacing_m * rng.uniform(0.5, 1.5)) < length_m()) {
      const double away_m = street_m * rng.uniform(kTreeNearest, kTreeFurthest);
      UprightPillar tree;
      tree.radius_m = rng.uniform(kTreeMinRadius_m, kTreeMaxRadius_m);
      const double height_m = rng.uniform(kTreeMinHeight_m, kTreeMaxHeight_m);
      const auto section = section_at(next_m, kSpacing_m);
      if (!section) continue;
      tree.centre_m = section->middle_m + away_m * section->away;
      const auto contains = [&](const UprightBox& house) {
        return floor_distance_m(house, tree.centre_m) <= tree.radius_m;
      };
      if (distance_m(path_, tree) >= kTreeClearance * street_m &&
          std::none_of(houses.begin(), houses.end(), contains)) {
        tree.bottom_m = bottom_m_;
        tree.top_m = highest_nearby_m(path_, tree) + height_m;
        trees.push_back(tree);
      }
    }
  }

 private:
  double length_m() const { return kSpacing_m * static_cast<double>(places_.size() - 1); }
  Eigen::Vector2d place_at(double along_m) const {
    return places_[static_cast<std::size_t>(std::lround(std::min(along_m, length_m()) / kSpacing_m))]
        .head<2>();
  }

  /// A section of the path.
  struct Section {
    Eigen::Vector2d middle_m;  ///< of its chord
    Eigen::Vector2d forward;
    Eigen::Vector2d away;  ///< from the path, to this side
  };
  /// Nothing where the path ends or turns back.
  std::optional<Section> section_at(double begin_m, double size_m) const {
    const Eigen::Vector2d begin = place_at(begin_m), end = place_at(begin_m + size_m);
    const double chord_m = (end - begin).norm();
    if (chord_m < 0.5 * size_m) return std::nullopt;
    const Eigen::Vector2d forward = (end - begin) / chord_m;
    return Section{0.5 * (begin + end), forward, direction_ * Eigen::Vector2d(-forward.y(), forward.x())};
  }

  std::optional<UprightBox> house_at(double along_m, const Eigen::Vector2d& size, double setback_m,
                                     double height_m) const {
    const auto section = section_at(along_m, size.x());
    if (!section) return std::nullopt;
    const double clear_m = std::hypot(0.5 * params_.houses.street_width_m, 0.5 * kSpacing_m);
    double away_m = clear_m + setback_m;
    const double max_m = away_m + kMaxPush_m;
    for (int push = 0; push <= kMaxPushes && away_m <= max_m; ++push) {
      UprightBox house{section->middle_m + (away_m + 0.5 * size.y()) * section->away, section->forward,
                       0.5 * size, bottom_m_, 0};
      const double lacking_m = clear_m - distance_m(path_, house);
      if (lacking_m > 0) {
        away_m += lacking_m + kPushedFurther_m;
        continue;
      }
      house.top_m = highest_nearby_m(path_, house) + height_m;
      return house;
    }
    return std::nullopt;
  }

  const Path& places_;
  const Path& path_;
  Direction direction_;
  const RoadsideParams& params_;
  double bottom_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace

WorldShapes build_roadside(const std::vector<Eigen::Vector3d>& path, const RoadsideParams& params,
                           double reach_m, const Rng& rng) {
  RADIOSLAM_CHECK(!path.empty(), "a path has a place");
  const Path places = places_along(path);
  Path all = path;
  all.insert(all.end(), places.begin(), places.end());
  const Side left(places, all, Side::kLeft, params), right(places, all, Side::kRight, params);
  WorldShapes shapes;
  shapes.ground = ground_under(places, reach_m);
  left.add_houses(shapes.boxes, rng.split("houses left"));
  right.add_houses(shapes.boxes, rng.split("houses right"));
  left.add_trees(shapes.boxes, shapes.pillars, rng.split("trees left"));
  right.add_trees(shapes.boxes, shapes.pillars, rng.split("trees right"));
  return shapes;
}

}  // namespace radioslam
