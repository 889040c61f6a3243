#include "radioslam/io/lidar/pcd.hpp"

#include <cmath>
#include <limits>

#include "io/refusal.hpp"
#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {
namespace {

LidarScan read_bytes_as_pcd(const std::string& bytes, Stamp stamp = {}) {
  return read_pcd({"scan.pcd", bytes}, stamp);
}

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   std::size_t points, const std::string& data) {
  return "# .PCD v.7\nVERSION .7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
         "\nDATA " + data + "\n";
}

TEST(Pcd, ReadsAsciiWithFieldsInAnyOrder) {
  const LidarScan scan = read_bytes_as_pcd(
      "FIELDS rgb z normal y x time\nSIZE 4 8 4 4 4 8\nTYPE F F F F F F\nCOUNT 1 1 3 1 1 1\nWIDTH 2\nHEIGHT "
      "1\nDATA ascii\nnan 3 0 0 1 2 1 0.25\n1.4e-45 nan 0 0 1 -inf 4e0 -1\n");
  ASSERT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(scan.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(scan.points[1].x(), 4);
  EXPECT_TRUE(std::isinf(scan.points[1].y()) && scan.points[1].y() < 0);
  EXPECT_TRUE(std::isnan(scan.points[1].z()));
  EXPECT_EQ(scan.times_s, (std::vector<float>{0.25F, -1}));
}

TEST(Pcd, ReadsBinaryRecordsOfMixedTypes) {
  std::string bytes = header("ring y x z", "2 4 8 4", "U F F F", 2, "binary");
  for (const float k : {0.0F, 1.0F}) {
    append_little_endian(bytes, 7, 2);
    append_f32(bytes, k + 2);
    append_f64(bytes, static_cast<double>(k) + 1);
    append_f32(bytes, k + 3);
  }
  const LidarScan scan = read_bytes_as_pcd(bytes);
  EXPECT_EQ(scan.points, (std::vector<Eigen::Vector3f>{{1, 2, 3}, {2, 3, 4}}));
  EXPECT_TRUE(scan.times_s.empty());
}

/// The columns of a table as hand-written LZF: x = 1 1 1, then copies of it for y and z.
TEST(Pcd, ReadsCompressedColumns) {
  std::string one;
  append_f32(one, 1);
  // 4 literals; a copy of 30 + 2 bytes at distance 4 (in the long form, because short copies have at most 8
  // bytes).
  const std::string lzf = std::string(1, '\3') + one + "\xe0" + std::string(1, 32 - 2 - 7) + "\3";
  std::string bytes = header("x y z", "4 4 4", "F F F", 3, "binary_compressed");
  append_little_endian(bytes, lzf.size(), 4);
  append_little_endian(bytes, 36, 4);
  EXPECT_EQ(read_bytes_as_pcd(bytes + lzf).points, std::vector<Eigen::Vector3f>(3, Eigen::Vector3f(1, 1, 1)));
  expect_refusal([&] { read_bytes_as_pcd(bytes + lzf.substr(1)); }, 0, "truncated");
  std::string corrupt = lzf;
  corrupt.back() = '\7';
  expect_refusal([&] { read_bytes_as_pcd(bytes + corrupt); }, 0, "cannot be decompressed");
}

TEST(Lzf, CopiesWhatItJustWrote) {
  // "ab", then 5 bytes at distance 2: a copy may overlap its own output.
  EXPECT_EQ(decompress_lzf(std::string("\1ab\x60\1", 5), 7), "abababa");
  EXPECT_EQ(decompress_lzf("", 0), "");
  EXPECT_FALSE(decompress_lzf(std::string("\1ab\x60\1", 5), 6)) << "more than expected";
  EXPECT_FALSE(decompress_lzf(std::string("\1ab\x60\1", 5), 8)) << "less than expected";
  EXPECT_FALSE(decompress_lzf(std::string("\1ab\x60\2", 5), 7)) << "from before the beginning";
  EXPECT_FALSE(decompress_lzf("\3ab", 4)) << "literals end early";
  EXPECT_FALSE(decompress_lzf(std::string("\1ab\xe0\1", 5), 7)) << "a long copy ends early";
  EXPECT_FALSE(decompress_lzf("x", std::size_t{1} << 40U)) << "nothing expands so far";
}

std::vector<float> times_of(const std::string& name, const std::string& size, const std::string& type,
                            const std::string& value, Stamp stamp) {
  return read_bytes_as_pcd(
             header("x y z " + name, "4 4 4 " + size, "F F F " + type, 1, "ascii") + "0 0 0 " + value + "\n",
             stamp)
      .times_s;
}

TEST(Pcd, TakesTimesInTheirUnitsAndSinceTheScansStamp) {
  const Stamp stamp{1'574'407'123'500'000'000};
  using Times = std::vector<float>;
  EXPECT_EQ(times_of("t", "4", "F", "0.5", stamp), Times{0.5F});
  EXPECT_EQ(times_of("time", "8", "F", "-0.5", stamp), Times{-0.5F});
  EXPECT_EQ(times_of("offset_time", "4", "U", "250000000", stamp), Times{0.25F});
  EXPECT_EQ(times_of("time_offset", "4", "I", "-250000000", stamp), Times{-0.25F});
  EXPECT_EQ(times_of("timestamp", "8", "F", "1574407123.75", stamp), Times{0.25F});
  EXPECT_EQ(times_of("timestamp", "8", "U", "1574407123750000000", stamp), Times{0.25F});
  EXPECT_NEAR(times_of("timestamp", "8", "F", "1574407123750000000", stamp)[0], 0.25, 1e-6);
  EXPECT_TRUE(times_of("when", "8", "F", "1", stamp).empty());
}

TEST(Pcd, FormatsWhatItReads) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& times : {std::vector<float>{}, std::vector<float>{0.125F, 0, -1}}) {
    const LidarScan scan{{{1.5F, -2, 1e-30F}, {nan, 0, 1}, {0, 0, 0}}, times};
    const LidarScan again = read_bytes_as_pcd(format_pcd(scan));
    ASSERT_EQ(again.points.size(), 3U);
    EXPECT_EQ(again.points[0], scan.points[0]);
    EXPECT_TRUE(std::isnan(again.points[1].x()));
    EXPECT_EQ(again.times_s, times);
  }
  EXPECT_TRUE(read_bytes_as_pcd(format_pcd({})).points.empty());
}

TEST(Pcd, RefusesWithTheLine) {
  const auto refuse = [](const std::string& bytes, std::size_t line, const char* words) {
    expect_refusal([&] { read_bytes_as_pcd(bytes); }, line, words);
  };
  const std::string xyz = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  refuse("", 0, "ends before DATA");
  refuse("VERSION 0.7\nPLY\n", 2, "not a line of a PCD header");
  refuse(xyz + "POINTS 1\n", 4, "ends before DATA");
  refuse(xyz + "DATA ascii\n", 4, "neither POINTS nor WIDTH");
  refuse(xyz + "POINTS 1\nPOINTS 1\n", 5, "twice");
  refuse(xyz + "POINTS -1\nDATA ascii\n", 5, "'-1' is not a valid count");
  refuse(xyz + "POINTS 3\nWIDTH 2\nHEIGHT 2\nDATA ascii\n", 7, "not WIDTH times HEIGHT");
  refuse(xyz + "WIDTH 4294967296\nHEIGHT 4294967296\nDATA binary\n", 6, "implausible");
  refuse(xyz + "POINTS 1\nDATA base64\n", 5, "'base64' is neither");
  refuse(xyz + "POINTS 2\nDATA ascii\n1 2 3\n", 6, "after 1 of 2");
  refuse(xyz + "POINTS 1\nDATA ascii\n1 2\n", 6, "ends before");
  refuse(xyz + "POINTS 1\nDATA ascii\n1 2 3 4\n", 6, "too many");
  refuse(xyz + "POINTS 1\nDATA ascii\n1 2 three\n", 6, "three");
  refuse(xyz + "POINTS 1\nDATA binary\n1234567890a", 0, "truncated");
  refuse(xyz + "POINTS 99\nDATA binary_compressed\n1234", 0, "truncated");
  refuse("FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 0\nDATA ascii\n", 5, "no z");
  refuse("FIELDS x y z\nSIZE 4 4 4\nTYPE F F I\nPOINTS 0\nDATA ascii\n", 5, "z is not a floating-point");
  refuse("FIELDS x y z\nSIZE 4 4 2\nTYPE F F F\nPOINTS 0\nDATA ascii\n", 5, "TYPE F and SIZE 2");
  refuse("FIELDS x y z\nSIZE 4 4\nTYPE F F F\nPOINTS 0\nDATA ascii\n", 5, "different lengths");
}

}  // namespace
}  // namespace radioslam
