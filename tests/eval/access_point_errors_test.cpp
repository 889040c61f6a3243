#include "radioslam/eval/access_point_errors.hpp"

#include <gtest/gtest.h>

#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

TEST(AccessPointErrors, AreOfTheAlignedEstimate) {
  Mission mission;
  mission.access_points = {"02:aa:00:00:00:00", "02:aa:00:00:00:01", "02:aa:00:00:00:02"};
  for (const auto& bssid : mission.access_points)
    mission.anchors.push_back({bssid, Eigen::Vector3d(10, 20, 3), 0});
  mission.anchors.push_back({"02:aa:00:00:00:09", Eigen::Vector3d(1, 2, 3), 0});  // received by nobody
  // The estimate's frame lies at (10, 0), turned left.
  const SE3 T_truth_estimate(Eigen::Vector3d(10, 0, 0), so3_exp({0, 0, 1.5707963267948966}));
  const auto errors = access_point_errors({{"02:aa:00:00:00:00", {20, 0}, true},
                                           {"02:aa:00:00:00:01", {24, 3}, true},
                                           {"02:aa:00:00:00:02", {0, 0}, false}},
                                          mission, T_truth_estimate);
  EXPECT_EQ(errors.known, 3U);
  EXPECT_EQ(errors.located, 2U) << "not the ambiguous one";
  ASSERT_TRUE(errors.errors);
  EXPECT_NEAR(errors.errors->mean_m, 2.5, 1e-9);
  EXPECT_FALSE(access_point_errors({}, mission, {}).errors);
}

}  // namespace
}  // namespace radioslam
