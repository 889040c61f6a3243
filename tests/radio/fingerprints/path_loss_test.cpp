#include <gtest/gtest.h>

#include "radioslam/radio/fingerprints/access_points.hpp"

namespace radioslam {
namespace {

TEST(PathLoss, FreeSpaceAsInTheTextbook) {
  EXPECT_NEAR(free_space_loss_db(1000, 1000), 92.44, 1e-9);
  EXPECT_NEAR(free_space_loss_db(1, 2400), 40.05, 0.01);  // WiFi over one metre
  EXPECT_NEAR(free_space_loss_db(20, 2400) - free_space_loss_db(10, 2400), 6.0206, 1e-4);
}

TEST(PathLoss, FreeSpaceDistanceUndoesTheLoss) {
  for (const double mhz : {2412.0, 5180.0})
    for (const double distance_m : {0.5, 10.0, 3000.0})
      EXPECT_NEAR(free_space_distance_m(free_space_loss_db(distance_m, mhz), mhz), distance_m,
                  1e-9 * distance_m);
}

TEST(PathLoss, LogDistanceLosesTenTimesTheExponentPerDecade) {
  const PathLoss law{-35, 2.7};
  EXPECT_DOUBLE_EQ(law.power_dbm(1), -35);
  EXPECT_NEAR(law.power_dbm(100), -35 - 54, 1e-9);
  EXPECT_NEAR(law.distance_m(law.power_dbm(17)), 17, 1e-9);
}

}  // namespace
}  // namespace radioslam
