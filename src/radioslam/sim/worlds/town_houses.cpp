#include "radioslam/sim/worlds/town_houses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr double kFoundation_m = 10;  ///< depth of houses below z = 0, so that hills never expose their base

/// Houses to the left of a street that begins at a crossing and runs along x.
class HouseRow {
 public:
  HouseRow(const SE2& T_common_street, const StreetGridParams& streets, const TownHouseParams& params)
      : T_common_street_(T_common_street), params_(params) {
    begin_m_ = 0.5 * params.street_width_m;
    end_m_ = streets.block_m - begin_m_;
  }

  void build(const Hills& ground, Rng rng, std::vector<UprightBox>& houses) const {
    double next_m = begin_m_;
    while (end_m_ - next_m >= params_.house_min_m) {
      const double width_m = std::min(draw_side_m(rng), end_m_ - next_m);
      const double front_m = begin_m_ + rng.uniform(0, params_.house_setback_m);
      const double back_m = std::min(front_m + draw_side_m(rng), end_m_);
      const double height_m = draw_m(params_.house_min_height_m, params_.house_max_height_m, rng);
      if (front_m < back_m)
        houses.push_back(house({next_m, front_m}, {next_m + width_m, back_m}, height_m, ground));
      next_m += width_m + rng.uniform(0, params_.house_gap_m);
    }
  }

 private:
  static double draw_m(double min_m, double max_m, Rng& rng) {
    return rng.uniform(min_m, std::max(min_m, max_m));
  }
  double draw_side_m(Rng& rng) const { return draw_m(params_.house_min_m, params_.house_max_m, rng); }

  UprightBox house(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double height_m,
                   const Hills& ground) const {
    const Eigen::Vector2d centre = T_common_street_ * Eigen::Vector2d(0.5 * (low + high));
    const double ground_m = ground.height_m(centre);
    return {centre, T_common_street_.rotate(Eigen::Vector2d::UnitX()), 0.5 * (high - low),
            ground_m - kFoundation_m, ground_m + height_m};
  }

  SE2 T_common_street_;
  const TownHouseParams& params_;
  double begin_m_ = 0, end_m_ = 0;
};

}  // namespace

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

std::vector<UprightBox> build_houses(const StreetGridParams& streets, const TownHouseParams& params,
                                     const Hills& ground, const Rng& rng) {
  std::vector<UprightBox> houses;
  const auto build_sides = [&](const Eigen::Vector2d& begin, const Eigen::Vector2d& end, const Rng& own) {
    const Eigen::Vector2d along = end - begin;
    const double heading_rad = std::atan2(along.y(), along.x());
    const SE2 there(begin, heading_rad), back(end, heading_rad + std::numbers::pi);
    HouseRow(there, streets, params).build(ground, own.split("left"), houses);
    HouseRow(back, streets, params).build(ground, own.split("right"), houses);
  };
  const double block_m = streets.block_m;
  for (int i = 0; i <= streets.blocks_x; ++i)
    for (int j = 0; j <= streets.blocks_y; ++j) {
      const Eigen::Vector2d crossing(i * block_m, j * block_m);
      const Rng own = rng.split(static_cast<std::uint64_t>(i)).split(static_cast<std::uint64_t>(j));
      if (i < streets.blocks_x)
        build_sides(crossing, crossing + Eigen::Vector2d(block_m, 0), own.split("along x"));
      if (j < streets.blocks_y)
        build_sides(crossing, crossing + Eigen::Vector2d(0, block_m), own.split("along y"));
    }
  return houses;
}

}  // namespace radioslam
