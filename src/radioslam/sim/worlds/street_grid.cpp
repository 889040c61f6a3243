#include "radioslam/sim/worlds/street_grid.hpp"

namespace radioslam {

LaneGrid make_streets(const StreetGridParams& params, Rng rng) {
  LaneGridParams lanes;
  lanes.floor_x_m = params.blocks_x * params.block_m;
  lanes.floor_y_m = params.blocks_y * params.block_m;
  lanes.aisles_along_y = params.blocks_x + 1;
  lanes.aisles_along_x = params.blocks_y + 1;
  lanes.margin_m = 0;
  lanes.closed_lane_ratio = params.closed_street_ratio;
  return LaneGrid(lanes, rng);
}

}  // namespace radioslam
