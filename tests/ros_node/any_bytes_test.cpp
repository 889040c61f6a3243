// Whatever bytes come on a robot's topics, its front end goes on.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "radioslam/base/random.hpp"
#include "radioslam/ros_node/robot_topics.hpp"
#include "ros_node/arrivals.hpp"

namespace radioslam {
namespace {

/// A message of the kind that its drivers would send.
std::string good_message(RobotTopicKind kind, std::string_view type, Stamp now) {
  switch (kind) {
    case RobotTopicKind::kOdometry:
      return odometry_message(now, SE3({now.seconds() - 1000, 0, 0}, Eigen::Quaterniond::Identity()));
    case RobotTopicKind::kScans: {
      if (type == kLaserScanType) return scan_message(now, "laser", std::vector<float>(300, 4));
      std::vector<MapPoint> points(600);
      for (std::size_t k = 0; k < points.size(); ++k)
        points[k].position = {static_cast<float>(k % 30), 5, static_cast<float>(k / 30)};
      return cloud_cdr({now, "laser"}, points);
    }
    case RobotTopicKind::kImu:
      return imu_message(now, "imu", {0, 0, 9.81});
    case RobotTopicKind::kRanges:
      return encode_cdr(RosRangeMeasurement{{now, ""}, "", "b", "", 5, 0.1});
    case RobotTopicKind::kAngles:
      return encode_cdr(RosAngleMeasurement{{now, ""}, "b", "", {{0.1, 0.2, 0.1, 0}, {1, {}, 0.1, 0}}});
    case RobotTopicKind::kWifi:
      return encode_cdr(RosWifiScan{{now, ""}, {{"00:16:ea:12:34:56", 2412, -60}}});
    default:
      return imu_message(now, "x", {1, 2, 3});  // of another type, if long enough
  }
}

std::string changed(std::string bytes, Rng& rng) {
  const auto below = [&](std::size_t most) {
    return static_cast<std::size_t>(rng.uniform(0, static_cast<double>(most)));
  };
  switch (below(4)) {
    case 0:
      bytes.resize(below(bytes.size() + 1));
      break;
    case 1:
      for (char& byte : bytes) byte = static_cast<char>(below(256));
      break;
    default:  // a few bytes, more often those of the front, which has counts and stamps
      for (std::size_t k = below(6) + 1; k > 0 && !bytes.empty(); --k)
        bytes[below(below(2) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 120))] =
            static_cast<char>(below(3) == 0 ? 255 : below(256));
  }
  return bytes;
}

/// Drives for `seconds` of the host's time, $RADIOSLAM_ANY_BYTES_S if that is given.
void expect_to_go_on(int dimension, bool has_scans, std::uint64_t seed) {
  Rng rng(seed);
  const char* asked = std::getenv("RADIOSLAM_ANY_BYTES_S");
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration<double>(asked != nullptr ? std::atof(asked) : 1.5);
  std::size_t messages = 0, samples = 0;
  while (std::chrono::steady_clock::now() < end) {  // a life
    RobotSamplesSetup setup;
    setup.origin = GeodeticPlace{0.8, 0.2, 500};
    setup.names.dimension = dimension;
    Listening robot(has_scans ? std::vector<std::string>{} : std::vector<std::string>{"scans=none"}, setup);
    const ScanParams scans;
    const KeyframeParams keyframes;
    CloudStore clouds;
    std::unique_ptr<FrontEnd> front_end;
    Stamp now = at(1000);
    for (int k = 0; k < 3000 && std::chrono::steady_clock::now() < end; ++k, now.ns += 20'000'000) {
      const auto& topics = robot.topics().measured;
      for (std::size_t number = 0; number < topics.size(); ++number) {
        const RobotTopic& topic = topics[number];
        const std::string type(types_of(
            topic.kind)[static_cast<std::size_t>(rng.uniform(0, 1.99)) % types_of(topic.kind).size()]);
        std::string cdr = good_message(topic.kind, type, now);
        if (rng.uniform(0, 1) < 0.5) cdr = changed(std::move(cdr), rng);
        robot.samples().take({number, {topic.name, type, MessageEncoding::kCdr}, now, now, std::move(cdr)});
        ++messages;
      }
      std::string transforms = transforms_cdr({{now, "base_link", "laser", SE3()}});
      robot.samples().take({RosArrival::kStaticTransforms,
                            {"/tf_static", "tf2_msgs/TFMessage"},
                            now,
                            now,
                            changed(std::move(transforms), rng)});
      robot.samples().advance(now);
      if (!front_end && robot.samples().sources())
        front_end = std::make_unique<FrontEnd>(robot.samples().names(), RobotIndex(0),
                                               *robot.samples().sources(), scans, keyframes, clouds);
      for (Sample& sample : robot.samples().take_samples()) {
        ++samples;
        front_end->add(std::move(sample));
      }
      if (front_end) front_end->take_records();
      robot.samples().take_notes();
    }
    if (front_end) front_end->finish();
  }
  EXPECT_GT(samples, 0U);
  testing::Test::RecordProperty("messages", static_cast<int>(messages));
}

TEST(AnyBytes, OfARobotWithOdometryAlone) { expect_to_go_on(2, false, 1); }
TEST(AnyBytes, OfARobotWithScansInThePlane) { expect_to_go_on(2, true, 2); }
TEST(AnyBytes, OfARobotWithScansInSpace) { expect_to_go_on(3, true, 3); }

}  // namespace
}  // namespace radioslam
