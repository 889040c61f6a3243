#include "radioslam/places/loops/storey.hpp"

#include <gtest/gtest.h>

#include "lidar/scanned_room.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kPointSpacing_m = 0.3;

ScanPyramid scan_in(const ScannedRoom& room, double tilt_rad = 0) {
  Rng rng(5);
  Scanner scanner;
  scanner.max_m = 80;
  const SE3 tilt(Eigen::Vector3d::Zero(),
                 Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY())));
  return pyramid_of(sweep(room, scanner, pose_at(0, 0, 1, 0.3) * tilt, rng), kPointSpacing_m,
                    ScannerKind::kSpatial);
}

ScannedRoom hall(double length_m, double width_m, double height_m) {
  ScannedRoom room;
  room.boxes = {{{-length_m / 2, -width_m / 2, 0}, {length_m / 2, width_m / 2, height_m}}};
  return room;
}

/// Under an open sky, with houses of these heights on either side.
ScannedRoom street(double left_m = 9, double right_m = 12, double wider_m = 0) {
  ScannedRoom room = hall(600, 600, 300);
  for (int k = -4; k <= 4; ++k) {
    room.boxes.push_back({{20.0 * k, 9 + wider_m, 0}, {20.0 * k + 17, 20 + wider_m, left_m + 0.3 * (k % 3)}});
    room.boxes.push_back(
        {{20.0 * k - 5, -22 - wider_m, 0}, {20.0 * k + 10, -12 - wider_m, right_m + 0.3 * (k % 2)}});
  }
  return room;
}

TEST(StoreyHeight, IsThatOfTheRoomButAtLeastThatOfAStorey) {
  EXPECT_NEAR(storey_height_m(scan_in(hall(12, 8, 3))).value_or(0), 2.8, 0.5);
  EXPECT_EQ(storey_height_m(scan_in(hall(4, 4, 10))).value_or(0), 2.5) << "seen up to 0.7 m";
}

TEST(StoreyHeight, IsThatOfABigHallToo) {
  for (const double tilt_rad : {0.0, 0.01, -0.02}) {
    EXPECT_NEAR(storey_height_m(scan_in(hall(90, 70, 8), tilt_rad)).value_or(0), 8, 1.5) << tilt_rad;
    EXPECT_TRUE(storey_height_m(scan_in(hall(140, 90, 6), tilt_rad))) << tilt_rad;
  }
}

TEST(StoreyHeight, IsNoneInTheOpen) {
  EXPECT_FALSE(storey_height_m(scan_in(street())));
  EXPECT_FALSE(storey_height_m(scan_in(street(), 0.02)));
  EXPECT_FALSE(storey_height_m(scan_in(street(3, 3.5, 10)))) << "low houses of one height";
  EXPECT_FALSE(storey_height_m(scan_in(hall(600, 600, 300)))) << "ground alone";
  EXPECT_FALSE(storey_height_m({}));
}

TEST(OtherStoreys, AreAsLikelyAsTheHeightLeavesThem) {
  constexpr double kStorey_m = 3;
  const auto others = [](double z_m, double sigma_m) {
    return other_storeys(kStorey_m, z_m, {{0, 1}}, sigma_m);
  };
  EXPECT_LT(others(0, 0.3), 1e-6);
  EXPECT_NEAR(others(0, 1000), 2, 1e-3) << "one above, one below";
  EXPECT_GT(others(kStorey_m, 0.3), 1e6) << "expected a storey below";
  EXPECT_NEAR(others(1, 1), others(-1, 1), 1e-12);
}

TEST(OtherStoreys, AreThoseThatOtherAlignmentsExpect) {
  const auto others = [](double share) { return other_storeys(3, 0, {{0, 1 - share}, {3.5, share}}, 0.1); };
  for (const double share : {0.1, 0.4}) EXPECT_NEAR(others(share), share / (1 - share), 1e-6);
  EXPECT_LT(others(0), 1e-9);
}

}  // namespace
}  // namespace radioslam
