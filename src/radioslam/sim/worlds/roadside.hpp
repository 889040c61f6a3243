// Roadside of a drive: the ground under it, and houses and trees along both sides, for drives recorded
// without their surroundings.
//
// One static world for all passages, from the drive's path alone. Rows of houses of random sizes, setbacks
// and gaps follow the path on both sides (town_houses.hpp). None is closer to any part of the path than half
// a street's width, none overlaps another, and each stands above the highest passage nearby. Trees and poles
// stand in front of the houses and between them. The ground follows the path's heights (path_ground.hpp).
// Frame: that of the path. Cost: squared in the path's length; a second or two for 3 km.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/worlds/ray_world.hpp"
#include "radioslam/sim/worlds/town_houses.hpp"

namespace radioslam {

struct RoadsideParams {
  double tree_spacing_m = 12;
  TownHouseParams houses;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(tree_spacing_m, "m", 1, 1e6, "mean distance between the trees on one side of a street");
    TownHouseParams::visit_fields(self.houses, visit);
  }
};

/// Along a path on the ground, at least one place; the ground reaches `reach_m` beyond it.
WorldShapes build_roadside(const std::vector<Eigen::Vector3d>& path, const RoadsideParams& params,
                           double reach_m, const Rng& rng);

}  // namespace radioslam
