// What stands still around robots, and what a ray from anywhere meets of it first: ground, perhaps a ceiling,
// upright boxes and pillars (upright_shapes.hpp).
//
// Exact: every shape is met where its own equation says; the grid (floor_grid.hpp) only leaves out shapes
// that the ray cannot meet. Common frame, metres. Cost of a ray: the cells on its way and the shapes in them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/sim/floor_grid.hpp"
#include "radioslam/sim/hills.hpp"
#include "radioslam/sim/upright_shapes.hpp"

namespace radioslam {

/// All of a world's surfaces.
struct WorldShapes {
  Hills ground;                     ///< z = 0 by default
  std::optional<double> ceiling_m;  ///< a level plane, endless
  std::vector<UprightBox> boxes;
  std::vector<UprightPillar> pillars;
};

class RayWorld {
 public:
  explicit RayWorld(WorldShapes shapes);

  /// Nothing where there is no surface within `most_m`.
  std::optional<RayHit> cast(const Ray& ray, double most_m) const;

 private:
  std::optional<RayHit> cast_at_ground(const Ray& ray, double most_m) const;
  std::optional<RayHit> cast_at_ceiling(const Ray& ray, double most_m) const;
  std::optional<RayHit> cast_at_shape(const Ray& ray, std::size_t shape) const;

  WorldShapes shapes_;
  FloorGrid grid_;  ///< of the boxes, then the pillars
};

}  // namespace radioslam
