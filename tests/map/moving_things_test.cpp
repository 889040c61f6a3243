// What moves is left out of a map, what stands still stays.
#include <gtest/gtest.h>

#include "map/street.hpp"
#include "radioslam/map/team_map.hpp"

namespace radioslam {
namespace {

using namespace street;

struct Counts {
  double still = 0, moving = 0;
};

Counts count(const TeamMap& map, const Street& street) {
  Counts counts;
  map.for_each_point([&](const Eigen::Vector3d& at, const MapPoint&) {
    ++(street.is_static(at, 0.15) ? counts.still : counts.moving);
  });
  return counts;
}

TEST(MovingThings, AreLeftOutAndHardlyAnythingElseIs) {
  Street street;
  street.duration_s = 45;
  street.steps = 400;
  street.add_traffic();
  MapParams keep_all;
  keep_all.views_per_s = 0;
  const Counts all = count(TeamMap(robots(street, 3), ScanPointParams{}, keep_all), street);
  const Counts left = count(TeamMap(robots(street, 3), ScanPointParams{}, MapParams{}), street);
  ASSERT_GT(all.moving, 3000);
  EXPECT_LT(left.moving, 0.02 * all.moving);
  EXPECT_GT(left.still, 0.99 * all.still);
}

TEST(MovingThings, AStreetWithoutThemIsKept) {
  Street street;
  street.duration_s = 20;
  street.steps = 360;
  const TeamMap map(robots(street, 2), ScanPointParams{}, MapParams{});
  const auto all = static_cast<double>(map.result().all_points + map.result().seen_through);
  EXPECT_LT(static_cast<double>(map.result().seen_through), 0.01 * all);
}

}  // namespace
}  // namespace radioslam
