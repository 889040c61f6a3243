#include "radioslam/study/wi_closure/place_truth.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

ClosureResult place_closure(const SE3& T_i_j, ClosureStatus status = ClosureStatus::kAccepted) {
  ClosureResult closure;
  closure.robot_i = RobotIndex(0);
  closure.robot_j = RobotIndex(1);
  closure.kind = ClosureKind::kLidar;
  closure.status = status;
  closure.T_i_j = T_i_j;
  return closure;
}

SE3 planar(double x_m, double yaw_rad, double z_m = 0) {
  return lift(SE2(Eigen::Vector2d(x_m, 0), yaw_rad), z_m);
}

/// Two robots that stand 5 m apart for a second.
Truth standing_apart() {
  const auto stand = [](const std::string& id, double x_m) {
    return RobotTruth{id, Trajectory<SE3>({{Stamp::from_seconds(0), planar(x_m, 0)},
                                           {Stamp::from_seconds(1), planar(x_m, 0)}})};
  };
  Truth truth;
  truth.robots = {stand("a", 0), stand("b", 5)};
  return truth;
}

TEST(PlaceTruth, AClosureIsTrueNearTheTrueRelativePose) {
  RunResult result;
  result.closures = {place_closure(planar(5.2, 0.04)), place_closure(planar(5.4, 0)),
                     place_closure(planar(5, 0.06)), place_closure(planar(5, 0), ClosureStatus::kRejected),
                     place_closure(planar(5, 0, 2))};
  result.closures.push_back(place_closure(planar(0, 0)));
  result.closures.back().robot_j = RobotIndex(0);
  result.closures.push_back(place_closure(planar(5, 0)));
  result.closures.back().stamp_j = Stamp::from_seconds(3);
  const PlaceClosures in_plane = count_place_closures(result, standing_apart());
  EXPECT_EQ(in_plane.accepted, 4U);
  EXPECT_EQ(in_plane.true_accepted, 2U);
  result.dimension = 3;
  EXPECT_EQ(count_place_closures(result, standing_apart()).true_accepted, 1U);
}

}  // namespace
}  // namespace radioslam
