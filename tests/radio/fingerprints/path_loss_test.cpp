#include <gtest/gtest.h>

#include "radioslam/radio/fingerprints/access_points.hpp"

namespace radioslam {
namespace {

TEST(PathLoss, LogDistanceLosesTenTimesTheExponentPerDecade) {
  const PathLoss law{-35, 2.7};
  EXPECT_DOUBLE_EQ(law.power_dbm(1), -35);
  EXPECT_NEAR(law.power_dbm(100), -35 - 54, 1e-9);
  EXPECT_NEAR(law.distance_m(law.power_dbm(17)), 17, 1e-9);
}

}  // namespace
}  // namespace radioslam
