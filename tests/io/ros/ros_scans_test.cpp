#include "radioslam/io/ros/ros_scans.hpp"

#include <cmath>
#include <map>

#include "io/refusal.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

const RosChannel kClouds{"/points", "sensor_msgs/PointCloud2", MessageEncoding::kRos1};

/// A cloud of points at 10 m, at every degree from `begin_deg` on, with `time_of` point k in ns, as float64.
template <class TimeOf>
std::string cloud(std::int64_t stamp_ns, int begin_deg, int points, TimeOf time_of) {
  RosBytes bytes(MessageEncoding::kRos1), rows(MessageEncoding::kRos1);
  for (int k = 0; k < points; ++k) {
    const auto angle = static_cast<float>((begin_deg + k) * std::acos(-1.0) / 180);
    rows.f32(10 * std::cos(angle)).f32(10 * std::sin(angle)).f32(1).f64(time_of(k));
  }
  const auto stamp = static_cast<std::uint64_t>(stamp_ns);
  bytes.header(stamp / 1'000'000'000, stamp % 1'000'000'000, "lidar").u32(1);
  bytes.u32(static_cast<std::uint64_t>(points)).u32(4);
  for (const auto& [axis, offset] : {std::pair("x", 0U), std::pair("y", 4U), std::pair("z", 8U)})
    bytes.text(axis).u32(offset).u8(7).u32(1);
  bytes.text("timestamp").u32(12).u8(8).u32(1);
  return bytes.u8(0).u32(20).u32(0).u32(rows.bytes().size()).raw(rows.bytes()).u8(1).bytes();
}

struct Scans {
  std::map<Stamp, LidarScan> scans;
  std::string notes;
};

Scans read(const std::vector<std::string>& messages) {
  Scans result;
  RosScans scans([&](Stamp stamp, RosScan scan) { result.scans[stamp] = std::move(scan.scan); });
  for (const std::string& bytes : messages) scans.take({kClouds, {1}, bytes, "x.bag"});
  scans.finish();
  for (const std::string& note : scans.notes()) result.notes += note + '\n';
  return result;
}

constexpr std::int64_t kBegin_ns = 1'732'600'000'000'000'000, kSweep_ns = 100'000'000;

TEST(RosScans, IgnoreTimesOfOneConstant) {
  std::vector<std::string> messages;
  for (int k = 0; k < 40; ++k)
    messages.push_back(cloud(kBegin_ns + k * kSweep_ns, 0, 360, [](int) { return 1.73260000123e18; }));
  const Scans read_scans = read(messages);
  ASSERT_EQ(read_scans.scans.size(), 40U);
  for (const auto& [stamp, scan] : read_scans.scans) EXPECT_TRUE(scan.times_s.empty());
  EXPECT_EQ(
      read_scans.notes,
      "/points: the points' times do not advance, within a scan or from scan to scan, and are ignored, in "
      "40 scans\n");
}

TEST(RosScans, IgnoreAbsoluteTimesThatAreTheSameInAllScans) {
  std::vector<std::string> messages;
  for (int k = 0; k < 12; ++k)
    messages.push_back(
        cloud(kBegin_ns + k * kSweep_ns, 0, 360, [](int p) { return 1.7326e18 + 250'000.0 * p; }));
  const Scans read_scans = read(messages);
  for (const auto& [stamp, scan] : read_scans.scans) EXPECT_TRUE(scan.times_s.empty());
  EXPECT_NE(read_scans.notes.find("do not advance"), std::string::npos) << read_scans.notes;
}

TEST(RosScans, GatherSlicesIntoSweeps) {
  std::vector<std::string> messages;
  for (int k = 0; k < 40; ++k) {
    const std::int64_t stamp_ns = kBegin_ns + k * kSweep_ns / 8;
    messages.push_back(
        cloud(stamp_ns, 45 * k, 45, [&](int p) { return static_cast<double>(stamp_ns) + 277'000.0 * p; }));
  }
  messages.insert(messages.begin() + 3, messages[2]);
  messages.insert(messages.begin() + 20, "torn");
  const Scans read_scans = read(messages);
  ASSERT_EQ(read_scans.scans.size(), 5U);
  for (const auto& [stamp, scan] : read_scans.scans) {
    EXPECT_EQ((stamp.ns - kBegin_ns) % kSweep_ns, 0);
    ASSERT_EQ(scan.points.size(), 360U);
    EXPECT_NEAR(scan.times_s.back(), 0.0997, 1e-4);
  }
  EXPECT_NE(read_scans.notes.find("/points: its 41 messages are slices of sweeps, 45 degrees each; they are "
                                  "gathered into 5 sweeps; 1 slices that repeat another one are left out\n"),
            std::string::npos)
      << read_scans.notes;
  EXPECT_NE(read_scans.notes.find("/points: 1 message is left out; the first: x.bag: "), std::string::npos);
}

TEST(RosScans, RefuseATopicThatCannotBeRead) {
  expect_refusal([] { read({"torn", "cloud"}); }, 0, "x.bag: a message of /points");
}

}  // namespace
}  // namespace radioslam
