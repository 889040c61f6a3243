// Ray casting in a static world: ground, optional ceiling, upright boxes and pillars (upright_shapes.hpp).
//
// Exact: hits follow from each shape's own equation; the grid (floor_grid.hpp) only skips shapes that the ray
// cannot hit. Common frame, metres. Cost of a ray: the cells that it passes, and the shapes in them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/sim/worlds/floor_grid.hpp"
#include "radioslam/sim/worlds/hills.hpp"
#include "radioslam/sim/worlds/upright_shapes.hpp"

namespace radioslam {

/// All surfaces of a world.
struct WorldShapes {
  Hills ground;                     ///< z = 0 by default
  std::optional<double> ceiling_m;  ///< an infinite horizontal plane
  std::vector<UprightBox> boxes;
  std::vector<UprightPillar> pillars;
};

class RayWorld {
 public:
  explicit RayWorld(WorldShapes shapes);

  /// The first hit; nothing if there is no surface within `max_m`.
  std::optional<RayHit> cast(const Ray& ray, double max_m) const;

 private:
  std::optional<RayHit> cast_at_ground(const Ray& ray, double max_m) const;
  std::optional<RayHit> cast_at_ceiling(const Ray& ray, double max_m) const;
  std::optional<RayHit> cast_at_shape(const Ray& ray, std::size_t shape) const;

  WorldShapes shapes_;
  FloorGrid grid_;  ///< of the boxes, then the pillars
};

}  // namespace radioslam
