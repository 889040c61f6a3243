#include "radioslam/lidar/scan_structure.hpp"

#include <gtest/gtest.h>

#include "lidar/scan_drive.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kOrderSpacing_m = 0.2;

double order_of(const LidarScan& scan, ScannerKind kind) {
  return planarity(surfels_of(scan, kOrderSpacing_m, kind), kind, {});
}

TEST(ScanOrder, IsInRoomsAndNotInNoise) {
  const double least = ScanStructureParams().min_structured_ratio;
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
    Rng rng(1);
    for (const double yaw : {0.0, 0.7, 2.0}) {
      EXPECT_GT(order_of(sweep(furnished_room(), scanner, pose_at(1, 0.5, 1.2, yaw), rng), kind), 2 * least);
      EXPECT_GT(order_of(sweep(furnished_hall(), scanner, pose_at(-3, 1, 1.2, yaw), rng), kind), 2 * least);
    }
    for (const int count : {20, 100, 500, 1500, 8000})
      EXPECT_LT(order_of(noise_scan(kind, count, rng), kind), least / 2) << count;
  }
}

TEST(ScanOrder, IsNotInTooFewPoints) {
  EXPECT_EQ(planarity({}, ScannerKind::kSpatial, {}), 0);
  const auto line = [](int count) {
    std::vector<Surfel> surfels;
    for (int k = 0; k < count; ++k)
      surfels.push_back({Eigen::Vector3f(0.2F * static_cast<float>(k), 1, 0), Eigen::Matrix3f::Identity()});
    return surfels;
  };
  EXPECT_EQ(planarity(line(19), ScannerKind::kPlanar, {}), 0);
  EXPECT_EQ(planarity(line(39), ScannerKind::kSpatial, {}), 0);
  EXPECT_EQ(planarity(line(40), ScannerKind::kSpatial, {}), 1);
  EXPECT_EQ(planarity(line(20), ScannerKind::kPlanar, {}), 1);
}

}  // namespace
}  // namespace radioslam
