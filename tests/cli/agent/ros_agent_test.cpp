// radioslam agent --ros2: a robot whose drivers publish what it measures.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "cli/process.hpp"
#include "io/dds/dds_test_domain.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/io/dds/team_channel.hpp"
#include "radioslam/io/ros/ros_topics.hpp"
#include "radioslam/ros_node/ros_subscriptions.hpp"
#include "radioslam/team/messages.hpp"
#include "ros_node/arrivals.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> ros_agent(const std::string& robot, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{
      "agent",       "--robot",    robot,         "--ros2",
      "--dimension", "2",          "--domain",    std::to_string(test_domain()),
      "--peer",      "127.0.0.1",  "--interface", "127.0.0.1",
      "-o",          "of-" + robot};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// A robot's drivers in a thread: it drives a metre a second along x, by odometry that starts at (5, 0), and
/// has the ranges of a radio.
class Drivers {
 public:
  /// `stamp_offset_s`: what its clock is ahead of the host's.
  explicit Drivers(const std::string& robot, const std::string& other, double stamp_offset_s = 0)
      : odometry_(domain_, "rt/" + robot + "/odom", dds_type("nav_msgs/msg/Odometry")),
        ranges_(domain_, "rt/" + robot + "/radioslam/ranges",
                dds_type("radioslam_msgs/msg/RangeMeasurement")),
        thread_([this, other, stamp_offset_s] {
          const Stamp begin = host_time();
          for (int k = 0; !is_over_; ++k) {
            const Stamp now = host_time(), stamp{now.ns + Stamp::from_seconds(stamp_offset_s).ns};
            static_cast<void>(odometry_.write(odometry_cdr({stamp, "odom", "base_link", pose(begin, now)})));
            if (k % 10 == 0)
              static_cast<void>(
                  ranges_.write(encode_cdr(RosRangeMeasurement{{stamp, ""}, "", other, "", 3, 0.1})));
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
        }) {}
  ~Drivers() {
    is_over_ = true;
    thread_.join();
  }

 private:
  static SE3 pose(Stamp begin, Stamp now) {
    return SE3({5 + seconds_between(begin, now), 0, 0}, Eigen::Quaterniond::Identity());
  }

  DdsDomain domain_{test_config()};
  DdsWriter odometry_, ranges_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;  // last, as it uses the others
};

/// The messages that somebody who watches a robot gets.
class Watcher {
 public:
  Watcher(const std::string& topic, const std::string& type)
      : channel_{topic, short_type(type)},
        reader_(domain_, dds_topic(topic), dds_type(type), {}, [this](const DdsReader::Sample& sample) {
          const std::lock_guard lock(mutex_);
          messages_.emplace_back(sample.cdr);
        }) {}

  bool has(std::size_t count) {
    return becomes_true([&] {
      const std::lock_guard lock(mutex_);
      return messages_.size() >= count;
    });
  }
  std::string last() {
    const std::lock_guard lock(mutex_);
    return messages_.back();
  }
  RosMessage message(const std::string& cdr) const { return {channel_, Stamp{}, cdr, "wire"}; }

 private:
  RosChannel channel_;
  std::mutex mutex_;
  std::vector<std::string> messages_;
  DdsDomain domain_{test_config()};
  DdsReader reader_;
};

TEST(RosAgents, MeasurePublishAndWriteWhatTheyKnow) {
  const TemporaryFolder place;
  const Drivers drivers("a", "b"), others("b", "a");
  auto words = ros_agent("a");
  words.insert(words.end(), {"--mcap", "a.mcap"});
  Started a(words, place.path()), b(ros_agent("b"), place.path());
  Watcher odometry("/a/radioslam/odom", "nav_msgs/msg/Odometry"), transforms("/tf", "tf2_msgs/msg/TFMessage"),
      path("/a/radioslam/path", "nav_msgs/msg/Path"),
      markers("/a/radioslam/markers", "visualization_msgs/msg/MarkerArray");
  ASSERT_TRUE(a.says("measures by /a/odom"));
  ASSERT_TRUE(a.says("hears robot b"));
  ASSERT_TRUE(odometry.has(60));
  const RosPose pose = read_ros_pose(odometry.message(odometry.last()));
  EXPECT_EQ(pose.header.frame + ' ' + pose.child, "a/radioslam_odom base_link");
  EXPECT_LT(std::abs(seconds_between(pose.header.stamp, host_time())), 5);
  EXPECT_GT(pose.pose->translation().x(), 1);
  ASSERT_TRUE(transforms.has(20));
  for (const RosPose& transform : read_ros_transforms(transforms.message(transforms.last())))
    EXPECT_TRUE(transform.child == "a/radioslam_odom" || transform.child == "odom" ||
                transform.child == "b/radioslam_odom")
        << transform.child;
  ASSERT_TRUE(path.has(2));
  ASSERT_TRUE(markers.has(1));
  std::this_thread::sleep_for(std::chrono::seconds(3));
  a.signal(SIGINT);
  b.signal(SIGTERM);
  for (Started* agent : {&a, &b}) {
    const Outcome outcome = agent->wait();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("DDS: topic"), std::string::npos) << outcome.out;
  }
  for (const char* file : {"a.tum", "b.tum", "summary.json", "report.html", "events.csv"})
    EXPECT_TRUE(fs::exists(place.path() / "of-a" / file)) << file;
  const RosTopicIndex recorded = index_recording(place.path() / "a.mcap");
  for (const char* topic : {"/a/radioslam/odom", "/a/radioslam/path", "/a/radioslam/markers", "/tf"})
    EXPECT_NE(recorded.find(topic), nullptr) << topic;
  EXPECT_GE(recorded.find("/a/radioslam/odom")->messages, 60U);
}

/// Of a robot alone the team's frame is where its odometry began: its pose there is by what its drivers say
/// and what is published.
TEST(RosAgents, TheFrameOfTheDriversOdometryIsPlacedInTheTeams) {
  const TemporaryFolder place;
  const Drivers drivers("a", "post");
  Started a(ros_agent("a"), place.path());
  Watcher transforms("/tf", "tf2_msgs/msg/TFMessage");
  ASSERT_TRUE(transforms.has(10));
  bool is_placed = false;
  for (const RosPose& transform : read_ros_transforms(transforms.message(transforms.last()))) {
    if (transform.child != "odom") continue;
    EXPECT_EQ(transform.header.frame, "a/map");
    EXPECT_LE(transform.pose->translation().x(), -5);  // by what it had driven when the robot was there
    EXPECT_NEAR(transform.pose->translation().y(), 0, 1e-9);
    is_placed = true;
  }
  EXPECT_TRUE(is_placed);
  a.signal(SIGINT);
  EXPECT_EQ(a.wait().status, 0);
}

/// A recorded robot with a scanner shows what it would have.
TEST(RosAgents, AMapIsPublishedWhereSomebodyLooks) {
  const TemporaryFolder place;
  ASSERT_EQ(
      run({"simulate", "hall", "-o", "m", "--seed", "1", "--set", "lidar_beams=16", "lidar_azimuth_steps=180",
           "lidar_rotation_hz=2", "hall_x_m=12", "hall_y_m=10", "path_length_m=12", "links=20"},
          place.path())
          .status,
      0);
  std::vector<std::string> call = ros_agent("a");
  call.erase(call.begin() + 3, call.begin() + 6);  // --ros2 --dimension 2
  call.insert(call.end(), {"--log", "m", "--publish", "--rate", "2"});
  Started a(call, place.path());
  Watcher map("/a/radioslam/map", "sensor_msgs/msg/PointCloud2"),
      grid("/a/radioslam/grid", "nav_msgs/msg/OccupancyGrid"), transforms("/tf", "tf2_msgs/msg/TFMessage");
  ASSERT_TRUE(map.has(1));
  ASSERT_TRUE(grid.has(1));
  const RosScan cloud = read_ros_scan(map.message(map.last()));
  EXPECT_TRUE(cloud.header.frame.ends_with("/map")) << cloud.header.frame;
  EXPECT_GT(cloud.scan.points.size(), 500U);
  for (const Eigen::Vector3f& point : cloud.scan.points) ASSERT_LT(point.norm(), 40) << "in a hall of 12 m";
  ASSERT_TRUE(transforms.has(1));
  std::vector<std::string> children;
  for (const RosPose& transform : read_ros_transforms(transforms.message(transforms.last())))
    children.push_back(transform.header.frame + " -> " + transform.child);
  ASSERT_EQ(children.size(), 2U);
  EXPECT_EQ(children[1], "a/odom -> a/base_link");
  a.signal(SIGINT);
  EXPECT_EQ(a.wait().status, 0);
}

TEST(RosAgents, StampsOfAnotherClockAreSaid) {
  const TemporaryFolder place;
  const Drivers drivers("a", "b", -1e6);
  Started a(ros_agent("a"), place.path());
  EXPECT_TRUE(a.says("topic /a/odom: stamps are far from this robot's clock"));
  a.signal(SIGINT);
  EXPECT_NE(a.wait().out.find("--use-sim-time"), std::string::npos);
}

TEST(RosAgents, NothingThatComesIsSaid) {
  const TemporaryFolder place;
  Started a(ros_agent("a"), place.path());
  EXPECT_TRUE(a.says("gets neither odometry nor scans, for which it looks at /a/odom"));
  a.signal(SIGINT);
  const Outcome outcome = a.wait();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("no robot has said anything"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(place.path() / "of-a"));
}

TEST(RosAgents, AMissingClockIsSaid) {
  const TemporaryFolder place;
  Started a(ros_agent("a", {"--use-sim-time"}), place.path());
  EXPECT_TRUE(a.says("waits for a time on /clock, where nothing has come for 5 s"));
  a.signal(SIGINT);
  const Outcome outcome = a.wait();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("no time has come on /clock"), std::string::npos) << outcome.err;
}

TEST(RosAgents, PeersThatAreNotUnderstoodAreSaid) {
  const TemporaryFolder place;
  Started a(ros_agent("a"), place.path());
  DdsDomain domain(test_config());
  TeamChannel old(domain, "old", [](TeamMessage) {}), other(domain, "other", [](TeamMessage) {});
  std::string bytes = encode("old", Digest{});
  bytes[3] = static_cast<char>(bytes[3] + 1);  // the version
  std::atomic<bool> is_over = false;
  std::thread sender([&] {
    for (; !is_over; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      static_cast<void>(old.send("", 0, bytes));
      static_cast<void>(other.send("", 0, "no message"));
    }
  });
  EXPECT_TRUE(a.says("refuses from robot old messages of another version of this program"));
  EXPECT_TRUE(a.says("refuses from robot other bytes that are no message"));
  is_over = true;
  sender.join();
  a.signal(SIGINT);
  a.wait();
}

/// For $RADIOSLAM_ANY_BYTES_S seconds, or a few.
TEST(RosAgents, AnyBytesOnEveryTopicDoNotEndThem) {
  const TemporaryFolder place;
  const Drivers drivers("a", "b");
  Started a(ros_agent("a"), place.path());
  ASSERT_TRUE(a.says("measures by /a/odom"));
  DdsDomain domain(test_config());
  std::vector<std::unique_ptr<DdsWriter>> writers;
  for (const auto& [topic, type] : std::vector<std::pair<std::string, std::string>>{
           {"/a/odom", "nav_msgs/msg/Odometry"},
           {"/a/radioslam/ranges", "radioslam_msgs/msg/RangeMeasurement"},
           {"/a/radioslam/angles", "radioslam_msgs/msg/AngleMeasurement"},
           {"/a/radioslam/wifi", "radioslam_msgs/msg/WifiScan"},
           {"/a/radioslam/csi", "radioslam_msgs/msg/CsiPacket"},
           {"/a/points", "sensor_msgs/msg/PointCloud2"},
           {"/a/imu", "sensor_msgs/msg/Imu"},
           {"/a/fix", "sensor_msgs/msg/NavSatFix"},
           {"/radioslam/team", "radioslam_msgs/msg/TeamMessage"},
           {"/radioslam/digest", "radioslam_msgs/msg/TeamMessage"},
           {"/radioslam/to/a", "radioslam_msgs/msg/TeamMessage"}})
    writers.push_back(std::make_unique<DdsWriter>(domain, dds_topic(topic), dds_type(type)));
  DdsQos kept;
  kept.durability = DdsDurability::kTransientLocal;
  writers.push_back(
      std::make_unique<DdsWriter>(domain, "rt/tf_static", dds_type("tf2_msgs/msg/TFMessage"), kept));
  const char* asked = std::getenv("RADIOSLAM_ANY_BYTES_S");
  const double seconds = asked != nullptr ? std::atof(asked) : 3;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  Rng rng(1);
  std::size_t sent = 0;
  while (std::chrono::steady_clock::now() < end)
    for (const auto& writer : writers) {
      CdrWriter out;
      write_header(out, {rng.below(2) == 0 ? host_time() : Stamp{}, "base_link"});
      std::string bytes = out.take();
      if (rng.below(4) == 0) bytes.resize(4);
      for (std::size_t k = rng.below(600); k > 0; --k)
        bytes += static_cast<char>(rng.below(rng.below(2) == 0 ? 256 : 3));
      sent += writer->write(bytes) ? 1U : 0U;
    }
  EXPECT_GT(sent, 100U);
  std::cout << sent << " messages\n";
  std::this_thread::sleep_for(std::chrono::seconds(1));
  a.signal(SIGINT);
  const Outcome outcome = a.wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(place.path() / "of-a/a.tum"));
}

TEST(RosAgents, WrongOptionsAreNamed) {
  const TemporaryFolder place;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"agent", "--robot", "a"}, "one of the two"},
      {{"agent", "--robot", "a", "--ros2", "--log", "town"}, "one of the two"},
      {{"agent", "--robot", "a", "--ros2"}, "--dimension: is wanted"},
      {{"agent", "--robot", "a", "--ros2", "--dimension", "2", "--topic", "lidar=/x"}, "no such kind"},
      {{"agent", "--robot", "a", "--ros2", "--dimension", "2", "--topic", "imu=/x y"}, "ROS allows"},
      {{"agent", "--robot", "a", "--ros2", "--dimension", "2", "--origin", "48"}, "LAT,LON"},
      {{"agent", "--robot", "a", "--ros2", "--mission", "nowhere"}, "no such mission folder"}};
  for (const auto& [call, what] : wrong) {
    std::vector<std::string> arguments = call;
    arguments.insert(arguments.end(), {"-o", "nothing"});
    const Outcome outcome = run(arguments, place.path());
    EXPECT_EQ(outcome.status, 2) << what;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(place.path() / "nothing"));
  }
}

}  // namespace
}  // namespace radioslam::cli
