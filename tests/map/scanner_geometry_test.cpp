// Where a scanner is, from its scans.
#include "radioslam/map/scanner_geometry.hpp"

#include <gtest/gtest.h>

#include "map/street.hpp"

namespace radioslam {
namespace {

LidarLog moved(LidarLog log, const Eigen::Vector3f& by) {
  return {log.stamps, [read = log.read, by](std::size_t k) {
            LidarScan scan = read(k);
            for (Eigen::Vector3f& point : scan.points) point += by;
            return scan;
          }};
}

TEST(ScannerGeometry, FindsTheScannerByItsRingsAndTheGroundBelow) {
  const street::Street street;
  const LidarLog log = street::robots(street, 1).front().scans;
  for (const Eigen::Vector3f& by : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0.4F, -0.2F, 1.1F)}) {
    const auto found = scanner_geometry(moved(log, by), ScannerKind::kSpatial, {});
    const Eigen::Vector3d expected = Eigen::Vector3d(0, 0, street::kScanner_m) + by.cast<double>();
    EXPECT_LT((found.scanner_m - expected).norm(), 0.05) << found.scanner_m.transpose();
    EXPECT_NEAR(found.ground_m, static_cast<double>(by.z()), 0.06);
  }
}

TEST(ScannerGeometry, AScannerWithoutRingsIsTakenToBeAtTheBody) {
  Rng rng(3);
  LidarScan scan;
  for (int k = 0; k < 5000; ++k)
    scan.points.emplace_back(
        Eigen::Vector3d(rng.normal(0, 5), rng.normal(0, 5), rng.normal(0, 2)).cast<float>());
  const LidarLog log{{Stamp{0}}, [&](std::size_t) { return scan; }};
  EXPECT_EQ(scanner_geometry(log, ScannerKind::kSpatial, {}).scanner_m, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace radioslam
