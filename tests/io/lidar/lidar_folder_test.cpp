#include "radioslam/io/lidar/lidar_folder.hpp"

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {
namespace {

std::string one_point(float x) {
  std::string bytes;
  for (const float number : {x, 2.0F, 3.0F, 7.0F}) append_f32(bytes, number);
  return bytes;
}

constexpr const char* kAsciiPcd =
    "VERSION 0.7\nFIELDS x y z t\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n"
    "DATA ascii\n1 2 3 500000000\n";

TEST(LidarFolder, ListsInTheOrderOfTimeNotOfNames) {
  const TemporaryFolder folder;
  folder.write("1000000000.bin", one_point(10));
  folder.write("900000000.bin", one_point(9));
  folder.write("-5.pcd", kAsciiPcd);
  folder.write(".6.bin", "hidden");
  folder.write("times.txt", "other");
  const LidarLog log = read_lidar_folder(folder.path());
  EXPECT_EQ(log.stamps, (std::vector<Stamp>{{-5}, {900'000'000}, {1'000'000'000}}));
  EXPECT_EQ(log.read(0).times_s, std::vector<float>{0.5F});
  EXPECT_EQ(log.read(1).points, std::vector<Eigen::Vector3f>{Eigen::Vector3f(9, 2, 3)});
  EXPECT_EQ(log.read(2).points, std::vector<Eigen::Vector3f>{Eigen::Vector3f(10, 2, 3)});
}

TEST(LidarFolder, ReadsWhenAskedOnly) {
  const TemporaryFolder folder;
  const auto file = folder.write("1.bin", one_point(1));
  const LidarLog log = read_lidar_folder(folder.path());
  folder.write("1.bin", "broken");
  expect_refusal([&] { log.read(0); }, 0, "1.bin: is not a scan: its 6 bytes");
  std::filesystem::remove(file);
  expect_refusal([&] { log.read(0); }, 0, "no such file");
}

TEST(LidarFolder, AnEmptyFileIsAScanAndNoFolderNone) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_lidar_folder(folder.path() / "none").empty());
  EXPECT_TRUE(read_lidar_folder(folder.path()).empty());
  folder.write("1.bin", "");
  const LidarLog log = read_lidar_folder(folder.path());
  ASSERT_EQ(log.size(), 1U);
  EXPECT_TRUE(log.read(0).points.empty());
}

TEST(LidarFolder, RefusesAtOnce) {
  const auto refuse = [](const std::vector<std::pair<const char*, std::string>>& files, const char* words) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : files) folder.write(name, content);
    expect_refusal([&] { read_lidar_folder(folder.path()); }, 0, words);
  };
  refuse({{"000001.5.bin", ""}}, "000001.5.bin: a scan must be named by its time in whole nanoseconds");
  refuse({{"scan.pcd", ""}}, "scan.pcd: a scan must be named");
  refuse({{"99999999999999999999.bin", ""}}, "a scan must be named");
  refuse({{"7.bin", one_point(1)}, {"7.pcd", kAsciiPcd}}, "7.pcd: another scan has the same time");
  refuse({{"7.bin", one_point(1) + "x"}}, "7.bin: is not a scan: its 17 bytes are not a multiple");
  const TemporaryFolder folder;
  expect_refusal([&] { read_lidar_folder(folder.write("lidar", "")); }, 0, "is a file");
}

}  // namespace
}  // namespace radioslam
