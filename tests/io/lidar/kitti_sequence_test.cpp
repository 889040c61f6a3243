#include "radioslam/io/lidar/kitti_sequence.hpp"

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/lidar/lidar_folder.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

const std::string kPoint(16, 'x');
/// Extrinsics of a forward-facing camera: its z is the LiDAR's x, its x the LiDAR's -y, its y the LiDAR's -z.
const std::string kCalibration = "P0: 7 0 0 0 0 7 0 0 0 0 1 0\nTr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n";
const std::string kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

TEST(KittiDrive, BringsCameraPosesIntoTheLidarsFrame) {
  const TemporaryFolder folder;
  folder.write("sequences/08/velodyne/000000.bin", kPoint);
  folder.write("sequences/08/velodyne/000001.bin", kPoint);
  folder.write("sequences/08/image_2/000000.png", "");
  folder.write("sequences/08/times.txt", "0.000000e+00\n1.036440e-01\n");
  folder.write("sequences/08/calib.txt", kCalibration);
  folder.write("poses/08.txt", kIdentity + "1 0 0 0 0 1 0 0 0 0 1 2.5\n");  // the camera moves along its z
  const KittiDrive drive = read_kitti_drive(folder.path() / "sequences/08", "a");
  EXPECT_EQ(drive.imported.mission.dimension, 3);
  ASSERT_EQ(drive.scans.size(), 2U);
  EXPECT_EQ(drive.scans[1].stamp, Stamp{103'644'000});
  const auto& truth = drive.imported.truth.robots.at(0).poses;
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_LT(truth[0].pose.log().norm(), 1e-12);
  EXPECT_LT((truth[1].pose.translation() - Eigen::Vector3d(2.5, 0, 0)).norm(), 1e-12)
      << "along the LiDAR's x";
  EXPECT_EQ(truth[1].stamp, drive.scans[1].stamp);
}

TEST(KittiDrive, TakesPosesAsTheLidarsWithoutACalibration) {
  const TemporaryFolder folder;
  folder.write("bin/000000.bin", kPoint);
  folder.write("poses_kitti.txt", "1 0 0 3 0 1 0 4 0 0 1 5\n");
  for (const std::filesystem::path& source :
       {folder.path(), folder.path() / "bin", folder.path() / "bin" / ""}) {
    const KittiDrive drive = read_kitti_drive(source, "a");
    ASSERT_EQ(drive.imported.truth.robots.size(), 1U) << source;
    EXPECT_EQ(drive.imported.truth.robots[0].poses[0].pose.translation(), Eigen::Vector3d(3, 4, 5));
  }
}

TEST(KittiDrive, NumbersScansByTheirNames) {
  const TemporaryFolder folder;
  folder.write("x_9.bin", kPoint);
  folder.write("x_10.bin", kPoint);
  const KittiDrive drive = read_kitti_drive(folder.path(), "a");
  ASSERT_EQ(drive.scans.size(), 2U);
  EXPECT_EQ(drive.scans[0].stamp, Stamp{900'000'000}) << "10 Hz";
  EXPECT_EQ(drive.scans[0].file.filename(), "x_9.bin");
  EXPECT_EQ(drive.scans[1].stamp, Stamp{1'000'000'000});
  EXPECT_TRUE(drive.imported.truth.robots.empty());
  std::string times;
  for (int k = 0; k < 11; ++k) times += std::to_string(2 * k) + "\n";
  folder.write("times.txt", times);  // of the whole drive
  EXPECT_EQ(read_kitti_drive(folder.path(), "a").scans[0].stamp, Stamp{18'000'000'000});
  folder.write("times.txt", "5\n6\n");  // of these scans
  EXPECT_EQ(read_kitti_drive(folder.path(), "a").scans[0].stamp, Stamp{5'000'000'000});
  folder.write("times.txt", "5\n6\n7\n");
  expect_refusal([&] { read_kitti_drive(folder.path(), "a"); }, 0,
                 "has 3 lines for 2 scans, but none for x_9.bin");
}

/// The scans' names and stamps, in order.
std::vector<std::pair<std::string, std::int64_t>> order_of(const std::vector<std::string>& names,
                                                           std::string* note = nullptr) {
  const TemporaryFolder folder;
  for (const std::string& name : names) folder.write(name + ".bin", kPoint);
  const KittiDrive drive = read_kitti_drive(folder.path(), "a");
  if (note != nullptr) *note = drive.imported.warnings.at(0);
  std::vector<std::pair<std::string, std::int64_t>> order;
  for (const KittiScan& scan : drive.scans) order.emplace_back(scan.file.stem().string(), scan.stamp.ns);
  return order;
}

TEST(KittiDrive, TakesTimesInNames) {
  using Order = std::vector<std::pair<std::string, std::int64_t>>;
  std::string note;
  EXPECT_EQ(order_of({"1630577759.068947", "1630577758.569490", "1630577758.67"}, &note),
            (Order{{"1630577758.569490", 1'630'577'758'569'490'000},
                   {"1630577758.67", 1'630'577'758'670'000'000},
                   {"1630577759.068947", 1'630'577'759'068'947'000}}));
  EXPECT_EQ(note, "there is no times.txt; the times in the scans' names are used");
  EXPECT_EQ(
      order_of({"x_1630577758.5", "x_1630577758.25"}),
      (Order{{"x_1630577758.25", 1'630'577'758'250'000'000}, {"x_1630577758.5", 1'630'577'758'500'000'000}}))
      << "within one second";
  EXPECT_EQ(order_of({"10.5", "9.75"}), (Order{{"9.75", 9'750'000'000}, {"10.5", 10'500'000'000}}));
  EXPECT_EQ(order_of({"1630577758569490", "1630577758469490"})[0].second, 1'630'577'758'469'490'000);
  EXPECT_EQ(order_of({"1630577758569490123", "1630577758469490123"})[0].second, 1'630'577'758'469'490'123);
}

TEST(KittiDrive, DistinguishesNumbersTimesAndNames) {
  using Order = std::vector<std::pair<std::string, std::int64_t>>;
  EXPECT_EQ(order_of({"v1.000002", "v1.000010"}),
            (Order{{"v1.000002", 200'000'000}, {"v1.000010", 1'000'000'000}}));
  EXPECT_EQ(order_of({"0000000000000002", "0000000000000010"}),
            (Order{{"0000000000000002", 200'000'000}, {"0000000000000010", 1'000'000'000}}));
  EXPECT_EQ(order_of({"9999999999999999"}), (Order{{"9999999999999999", 0}})) << "beyond all times";
  EXPECT_EQ(order_of({"b_1", "a_9", "a_2"}), (Order{{"a_2", 0}, {"a_9", 100'000'000}, {"b_1", 200'000'000}}))
      << "of two drives, as it seems: by name";
  const TemporaryFolder folder;
  for (const char* name : {"12.5.bin", "13.5.bin"}) folder.write(name, kPoint);
  folder.write("times.txt", "7\n8\n");
  EXPECT_EQ(read_kitti_drive(folder.path(), "a").scans[1].stamp, Stamp{8'000'000'000})
      << "the list counts more";
  folder.write("times.txt", "6\n7\n8\n");
  expect_refusal([&] { read_kitti_drive(folder.path(), "a"); }, 0, "has 3 lines for 2 scans");
}

TEST(KittiDrive, Refuses) {
  const TemporaryFolder folder;
  const auto read = [&] { read_kitti_drive(folder.path(), "a"); };
  expect_refusal(read, 0, "contains no scans");
  folder.write("0.bin", "17 bytes of points");
  expect_refusal(read, 0, "0.bin: is not a scan");
  folder.write("0.bin", kPoint);
  folder.write("times.txt", "1\n1\n");
  expect_refusal(read, 2, "times.txt:2: the time does not increase");
  folder.write("times.txt", "1\n");
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 2 0\n");
  expect_refusal(read, 1, "poses.txt:1: the first three columns are not a rotation matrix");
  folder.write("poses.txt", kIdentity);
  expect_refusal([&] { read_kitti_drive(folder.path(), "a", folder.path() / "none"); }, 0, "no such file");
  folder.write("calib.txt", "Tr: 1 0 0\n");
  expect_refusal(read, 1, "calib.txt:1: ");
  expect_refusal([&] { read_kitti_drive(folder.path() / "0.bin", "a"); }, 0, "is a file");
}

/// Four complete scans whose names end in their numbers.
TEST(KittiDrive, CopiesRecordedScans) {
  RADIOSLAM_RECORDED(source, "lidar_kitti");
  const KittiDrive drive = read_kitti_drive(source, "a");
  ASSERT_EQ(drive.scans.size(), 4U);
  const TemporaryFolder folder;
  copy_kitti_scans(drive, folder.path() / "lidar");
  const LidarLog log = read_lidar_folder(folder.path() / "lidar");
  EXPECT_EQ(log.stamps,
            (std::vector<Stamp>{{9'400'000'000}, {9'500'000'000}, {19'800'000'000}, {19'900'000'000}}));
  EXPECT_EQ(log.read(0).points.size(), 1'945'888U / 16U);
  EXPECT_EQ(folder.read("lidar/9400000000.bin"), read_bytes(source / "kitti00_000094.bin"));
}

}  // namespace
}  // namespace radioslam
