#include "radioslam/io/lidar/bin_layout.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/io/lidar/kitti_sequence.hpp"
#include "radioslam/io/lidar/lidar_folder.hpp"
#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {
namespace {

/// A room of 20 m by 12 m, as points x y z intensity ring time ... of this many floats.
std::string room(std::size_t points, std::size_t floats, double intensity) {
  Rng random(7);
  std::string bytes;
  for (std::size_t k = 0; k < points; ++k) {
    const double angle = 0.0174 * static_cast<double>(k);
    const double range = std::min(10 / std::abs(std::cos(angle)), 6 / std::abs(std::sin(angle)));
    const std::vector<double> values{range * std::cos(angle),
                                     range * std::sin(angle),
                                     random.uniform(-1, 2),
                                     intensity * random.uniform(0, 1),
                                     static_cast<double>(k % 32),
                                     1e-5 * static_cast<double>(k),
                                     1};
    for (std::size_t c = 0; c < floats; ++c) append_f32(bytes, static_cast<float>(values[c]));
  }
  return bytes;
}

TEST(BinLayout, FindsTheFloatsOfAPoint) {
  for (const std::size_t floats : {3U, 4U, 5U, 6U, 7U})
    for (const double intensity : {0.0, 1.0, 255.0}) {
      EXPECT_EQ(floats_per_point(room(1680, floats, intensity)), floats) << intensity;
      EXPECT_EQ(floats_per_point(room(840, floats, intensity)), floats) << intensity;
    }
}

TEST(BinLayout, IsKittisWithoutEvidence) {
  EXPECT_EQ(floats_per_point(""), 4U);
  EXPECT_EQ(floats_per_point(std::string(16 * 420, '\0')), 4U);
  EXPECT_EQ(floats_per_point(room(60, 5, 1)), 4U) << "too few points";
}

TEST(BinLayout, OfAnotherNumberIsRefusedInMissionsAndConvertedByTheImport) {
  const TemporaryFolder folder;
  const std::string five = room(1680, 5, 1);
  folder.write("100.bin", five);
  folder.write("times.txt", "1\n");
  const LidarLog log = read_lidar_folder(folder.path());
  expect_refusal([&] { log.read(0); }, 0,
                 "100.bin: is not a scan of x y z intensity: its points have 5 floats");
  const KittiDrive drive = read_kitti_drive(folder.path(), "a");
  EXPECT_NE(drive.imported.warnings.front().find("have 5 floats each"), std::string::npos);
  const TemporaryFolder copied;
  copy_kitti_scans(drive, copied.path());
  const LidarScan scan = read_lidar_folder(copied.path()).read(0);
  ASSERT_EQ(scan.points.size(), 1680U);
  const ByteView view(five, ByteOrder::kLittle);
  EXPECT_EQ(scan.points[9], Eigen::Vector3f(view.f32(180), view.f32(184), view.f32(188)));
  folder.write("101.bin", five.substr(0, 32));
  folder.write("times.txt", "1\n2\n");
  expect_refusal([&] { read_kitti_drive(folder.path(), "a"); }, 0, "101.bin: is not a scan");
}

}  // namespace
}  // namespace radioslam
