// A robot's subscriptions: they read what is there as it is sent, and say what is not.
#include "radioslam/ros_node/ros_subscriptions.hpp"

#include <gtest/gtest.h>

#include <mutex>

#include "io/dds/dds_test_domain.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/ros_node/ros_clock.hpp"
#include "radioslam/ros_node/ros_publisher.hpp"
#include "ros_node/arrivals.hpp"

namespace radioslam {
namespace {

class Subscribed {
 public:
  explicit Subscribed(const std::vector<std::string>& topics = {})
      : topics_(robot_topics("/a", topics)),
        subscriptions_(domain_, topics_, host_time, [this](RosArrival arrival) {
          const std::lock_guard lock(mutex_);
          arrivals_.push_back(std::move(arrival));
        }) {}

  /// `later_s`: as if so much time had passed.
  void look(double later_s = 0) {
    subscriptions_.look({host_time().ns + at(later_s).ns});
    for (std::string& note : subscriptions_.take_notes()) notes_.push_back(std::move(note));
  }
  bool hears(std::size_t count) {
    return becomes_true([&] {
      look();
      const std::lock_guard lock(mutex_);
      return arrivals_.size() >= count;
    });
  }
  std::vector<RosArrival> arrivals() {
    const std::lock_guard lock(mutex_);
    return arrivals_;
  }
  std::size_t notes(const std::string& words) const {
    return static_cast<std::size_t>(std::count_if(notes_.begin(), notes_.end(), [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    }));
  }
  const std::vector<std::string>& notes() const { return notes_; }
  DdsDomain& domain() { return domain_; }

 private:
  DdsDomain domain_{test_config()};
  RobotTopics topics_;
  std::mutex mutex_;
  std::vector<RosArrival> arrivals_;
  std::vector<std::string> notes_;
  RosSubscriptions subscriptions_;  // last, as it calls back
};

/// A driver of the robot.
class Driver {
 public:
  Driver(const std::string& topic, const std::string& type, const DdsQos& qos = {})
      : writer_(domain_, dds_topic(topic), dds_type(type), qos) {}

  bool is_read() const { return writer_.matched() > 0; }
  bool send(const std::string& cdr) { return writer_.write(cdr); }

 private:
  DdsDomain domain_{test_config()};
  DdsWriter writer_;
};

bool announced(Subscribed& robot, std::size_t writers) {
  return becomes_true([&] {
    const auto all = robot.domain().writers();
    return static_cast<std::size_t>(std::count_if(
               all.begin(), all.end(), [](const DdsEndpoint& writer) { return !writer.is_own; })) >= writers;
  });
}

TEST(RosSubscriptions, ReadsAsDriversSend) {
  DdsQos best_effort;
  best_effort.reliability = DdsReliability::kBestEffort;
  Subscribed robot;
  Driver odometry("/a/odom", "nav_msgs/msg/Odometry"),
      scans("/a/scan", "sensor_msgs/msg/LaserScan", best_effort);
  ASSERT_TRUE(becomes_true([&] {
    robot.look();
    return odometry.is_read() && scans.is_read();
  }));
  EXPECT_TRUE(odometry.send(odometry_message(at(5), SE3())));
  EXPECT_TRUE(becomes_true([&] {
    return scans.send(scan_message(at(5), "laser", {1, 2})) && robot.hears(2);
  }));
  for (const RosArrival& arrival : robot.arrivals())
    EXPECT_EQ(arrival.channel.type,
              arrival.channel.topic == "/a/odom" ? "nav_msgs/Odometry" : "sensor_msgs/LaserScan");
  EXPECT_EQ(robot.domain().take_notes(), std::vector<std::string>{});
}

TEST(RosSubscriptions, StaticTransformsAreHeardThoughTheyWereSentBefore) {
  DdsQos kept;
  kept.durability = DdsDurability::kTransientLocal;
  Driver transforms("/tf_static", "tf2_msgs/msg/TFMessage", kept);
  EXPECT_TRUE(transforms.send(transforms_cdr({{{}, "base_link", "laser", SE3()}})));
  Subscribed robot;
  ASSERT_TRUE(robot.hears(1));
  EXPECT_EQ(robot.arrivals()[0].topic, RosArrival::kStaticTransforms);
}

TEST(RosSubscriptions, ATopicThatNobodyPublishesIsSaidWithThoseOfItsType) {
  Subscribed robot({"odometry=/a/odom"});
  robot.look();
  EXPECT_EQ(robot.notes(), std::vector<std::string>{});
  robot.look(6);
  robot.look(7);
  EXPECT_EQ(
      robot.notes("topic /a/odom: nothing has come for 5 s; nobody publishes it, and nothing of its type"),
      1U);
  Subscribed other({"odometry=/a/odom"});
  Driver elsewhere("/robot_a/odom", "nav_msgs/msg/Odometry");
  ASSERT_TRUE(announced(other, 1));
  other.look();
  other.look(6);
  EXPECT_EQ(other.notes("of its type there is /robot_a/odom, a namespace or a remap may differ"), 1U);
}

TEST(RosSubscriptions, ARobotWithoutAnySensorSaysWhereItLooks) {
  Subscribed robot;
  Driver elsewhere("/lidar/points", "sensor_msgs/msg/PointCloud2");
  ASSERT_TRUE(announced(robot, 1));
  robot.look();
  robot.look(6);
  ASSERT_EQ(robot.notes("gets neither odometry nor scans, for which it looks at /a/odom"), 1U);
  EXPECT_EQ(robot.notes("there is /lidar/points, which --topic KIND=NAME takes"), 1U);
}

TEST(RosSubscriptions, ADriverThatSendsNothingIsSaid) {
  Subscribed robot;
  Driver odometry("/a/odom", "nav_msgs/msg/Odometry");
  ASSERT_TRUE(announced(robot, 1));
  robot.look();
  robot.look(6);
  EXPECT_EQ(robot.notes("it is published, but nothing has ever come"), 1U);
}

TEST(RosSubscriptions, ADriverThatStopsIsSaid) {
  Subscribed robot;
  {
    Driver odometry("/a/odom", "nav_msgs/msg/Odometry");
    ASSERT_TRUE(becomes_true([&] {
      robot.look();
      return odometry.is_read();
    }));
    EXPECT_TRUE(odometry.send(odometry_message(at(5), SE3())));
    ASSERT_TRUE(robot.hears(1));
    robot.look(6);
    robot.look(8);
    EXPECT_EQ(robot.notes("it is published, has its sensor stopped?"), 1U);
  }
  ASSERT_TRUE(becomes_true([&] {
    robot.look(6);
    return robot.notes("nobody publishes it any more") == 1;
  }));
}

TEST(RosSubscriptions, ADriverOfAnotherTypeIsSaid) {
  Subscribed robot;
  Driver odometry("/a/odom", "geometry_msgs/msg/PoseStamped");
  ASSERT_TRUE(announced(robot, 1));
  robot.look();
  const auto notes = robot.domain().take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(
      notes[0].find("/odom: a publisher sends geometry_msgs/msg/PoseStamped, this robot reads nav_msgs"),
      std::string::npos)
      << notes[0];
}

TEST(RosSubscriptions, AnotherDriverOfTheRightTypeIsThenRead) {
  Subscribed robot;
  const Driver wrong("/a/scan", "geometry_msgs/msg/PoseStamped");
  ASSERT_TRUE(announced(robot, 1));
  robot.look();
  Driver scans("/a/scan", "sensor_msgs/msg/LaserScan");
  ASSERT_TRUE(becomes_true([&] {
    robot.look();
    return scans.is_read();
  }));
}

TEST(RosClock, ShowsWhatItHears) {
  DdsDomain domain(test_config());
  RosClock clock(domain, "/clock");
  EXPECT_FALSE(clock.has_begun());
  Driver simulation("/clock", "rosgraph_msgs/msg/Clock");
  const auto time = [](unsigned seconds) {
    return CdrWriter().i32(static_cast<std::int32_t>(seconds)).u32(7).take();
  };
  ASSERT_TRUE(becomes_true([&] {
    return simulation.send(time(0).substr(0, 6)) && simulation.send(time(12)) && clock.has_begun();
  }));
  EXPECT_EQ(clock.now(), Stamp{12'000'000'007});
}

TEST(DdsSink, PublishesWhatSomebodyReads) {
  DdsDomain a(test_config()), b(test_config());
  DdsSink sink(a, {{"/a/radioslam/path", "nav_msgs/msg/Path", true}});
  RosPublisher publisher;
  publisher.add(sink);
  EXPECT_FALSE(publisher.wants("/a/radioslam/path"));
  EXPECT_FALSE(publisher.wants("/a/other"));
  std::atomic<std::size_t> received = 0;
  const DdsReader reader(b, dds_topic("/a/radioslam/path"), dds_type("nav_msgs/msg/Path"), {},
                         [&](const DdsReader::Sample&) { ++received; });
  ASSERT_TRUE(becomes_true([&] { return publisher.wants("/a/radioslam/path"); }));
  publisher.publish({"/a/radioslam/path", "nav_msgs/msg/Path", "", Stamp{}, path_cdr({{}, "a/map"}, {})});
  EXPECT_TRUE(becomes_true([&] { return received == 1; }));
}

}  // namespace
}  // namespace radioslam
