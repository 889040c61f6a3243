// A recorded robot, message by message as its drivers sent them, measures what the import of the recording
// has.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "io/dds/dds_test_domain.hpp"
#include "io/recorded_data.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/io/ros/ros_import.hpp"
#include "radioslam/io/ros/ros_ranges.hpp"
#include "radioslam/ros_node/ros_clock.hpp"
#include "radioslam/ros_node/ros_subscriptions.hpp"
#include "ros_node/arrivals.hpp"

namespace radioslam {
namespace {

/// The time by the clock of the messages' stamps: recordings of simulations, or of clocks that differ, have
/// another one.
Stamp time_of_stamps(const RosMessage& message, const RosTopicIndex& index) {
  return {message.stamp.ns - index.recording_delay.ns};
}

/// Plays the messages of some topics by DDS, with their time on /clock, `rate` times faster than they were
/// recorded.
void play(const std::filesystem::path& recording, const std::map<std::string, std::string>& types,
          double rate) {
  DdsDomain domain(test_config());
  DdsWriter clock(domain, "rt/clock", dds_type("rosgraph_msgs/msg/Clock"));
  std::map<std::string, std::unique_ptr<DdsWriter>> writers;
  DdsQos deep;
  deep.depth = 1000;
  deep.longest_wait_s = 10;
  for (const auto& [topic, type] : types)
    writers[topic] = std::make_unique<DdsWriter>(domain, dds_topic(topic), dds_type(type), deep);
  ASSERT_TRUE(becomes_true([&] {
    return clock.matched() > 0 && std::all_of(writers.begin(), writers.end(), [](const auto& writer) {
             return writer.second->matched() > 0;
           });
  }));
  const RosTopicIndex index = index_recording(recording);
  std::optional<Stamp> begin;
  const auto start = std::chrono::steady_clock::now();
  visit_recording(
      recording,
      {[&](const RosChannel& channel) { return writers.contains(channel.topic); },
       [&](const RosMessage& message) {
         if (!writers.contains(message.channel.topic)) return;
         if (!begin) begin = message.stamp;
         std::this_thread::sleep_until(
             start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                         std::chrono::duration<double>(seconds_between(*begin, message.stamp) / rate)));
         const Stamp now = time_of_stamps(message, index);
         CdrWriter time;
         time.i32(static_cast<std::int32_t>(now.ns / 1'000'000'000));
         time.u32(static_cast<std::uint32_t>(now.ns % 1'000'000'000));
         ASSERT_TRUE(clock.write(time.take()));
         ASSERT_TRUE(writers.at(message.channel.topic)->write(message.bytes));
       }});
  ASSERT_TRUE(becomes_true([&] {
    return std::all_of(writers.begin(), writers.end(),
                       [](const auto& writer) { return writer.second->is_acknowledged(); });
  }));
}

void expect_odometry(const std::vector<StampedPose<SE3>>& rows, const Trajectory<SE3>& expected) {
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].stamp, expected[k].stamp) << k;
    ASSERT_LT((rows[k].pose.inverse() * expected[k].pose).log().norm(), 1e-9) << k;
  }
}

/// The recording's messages as a robot hears them that is there when they are sent.
void expect_as_imported(const std::filesystem::path& recording, const RosTopicRequest& request,
                        const std::vector<std::string>& stated) {
  std::map<Stamp, LidarScan> scans;
  const RosImport imported = import_ros_recording(
      recording, "a", request, [&](Stamp stamp, const LidarScan& scan) { scans[stamp] = scan; });
  const RosTopicIndex index = index_recording(recording);
  Listening robot(stated);
  visit_recording(recording,
                  {[](const RosChannel&) { return true; },
                   [&](const RosMessage& message) {
                     const bool is_read =
                         message.channel.topic == "/tf_static" ||
                         std::any_of(robot.topics().measured.begin(), robot.topics().measured.end(),
                                     [&](const RobotTopic& of) { return of.name == message.channel.topic; });
                     if (is_read)
                       robot.hear(message.channel.topic, message.channel.type, std::string(message.bytes),
                                  time_of_stamps(message, index));
                   }});
  const Robot& expected = imported.imported.mission.robots.front();
  expect_odometry(robot.all<StampedPose<SE3>>(), expected.odometry);
  const auto inertial = robot.all<ImuSample>();
  ASSERT_EQ(inertial.size(), expected.inertial.size());
  for (std::size_t k = 0; k < inertial.size(); ++k)
    ASSERT_EQ(inertial[k].specific_force_mps2, expected.inertial[k].specific_force_mps2) << k;
  const auto heard = robot.all<ScanSample>();
  ASSERT_EQ(heard.size(), scans.size());
  for (const ScanSample& sample : heard) {
    ASSERT_TRUE(scans.contains(sample.stamp));
    EXPECT_EQ(sample.scan.points, scans[sample.stamp].points);
    EXPECT_EQ(sample.scan.times_s, scans[sample.stamp].times_s);
  }
}

TEST(RecordedRobot, OfTheNavigationStackIsAsImported) {
  RADIOSLAM_RECORDED(recording, "ros_logs/nav2_turtlebot.mcap");
  RosTopicRequest request;
  request.odometry = "/odom";
  expect_as_imported(recording, request, {"odometry=/odom"});
}

TEST(RecordedRobot, OfATeamWithRadiosIsAsImported) {
  RADIOSLAM_RECORDED(recording, "tiers/shortbag.db3");
  RosTopicRequest request;
  request.odometry = "/turtle02/odom";
  request.scans = request.imu = request.gnss = request.wifi = "none";
  expect_as_imported(recording, request, {"odometry=/turtle02/odom"});
}

TEST(RecordedRobot, ItsRangesAreAsImported) {
  RADIOSLAM_RECORDED(recording, "tiers/shortbag.db3");
  const std::string topic = "/uwb/tof/n_2/n_4/distance";
  RosRangeRequest request;
  request.ends[topic] = {"a", "n_4"};
  request.robots = {"a", "n_4"};
  const RosTopicIndex index = index_recording(recording);
  const RosRanges imported = read_ros_ranges(recording, index, request);
  Listening robot({"odometry=/turtle02/odom", "range:n_4=" + topic});
  visit_recording(recording,
                  {[](const RosChannel&) { return true; },
                   [&](const RosMessage& message) {
                     if (message.channel.topic == topic || message.channel.topic == "/turtle02/odom")
                       robot.hear(message.channel.topic, message.channel.type, std::string(message.bytes),
                                  time_of_stamps(message, index));
                   }});
  const auto ranges = robot.all<RangeMeasurement>();
  ASSERT_EQ(ranges.size(), imported.ranges.size());
  ASSERT_GT(ranges.size(), 100U);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    EXPECT_EQ(ranges[k].stamp, imported.ranges[k].stamp);
    EXPECT_EQ(ranges[k].range_m, imported.ranges[k].range_m);
    EXPECT_EQ(ranges[k].sigma_m, imported.ranges[k].sigma_m);
  }
}

/// Recorded messages, published as they are, are taken in as the import reads them.
TEST(RecordedRobot, PlayedByDdsIsAsImported) {
  RADIOSLAM_RECORDED(recording, "ros_logs/nav2_turtlebot.mcap");
  RosTopicRequest request;
  request.odometry = "/odom";
  const RosImport imported = import_ros_recording(recording, "a", request, [](Stamp, const LidarScan&) {});
  RobotSamplesSetup setup;
  setup.names.robots.emplace_back().id = "a";
  setup.self = RobotIndex(0);
  setup.topics = robot_topics("", {});
  setup.is_simulated = true;
  RobotSamples samples(setup);
  std::mutex mutex;
  std::vector<RosArrival> arrivals;
  DdsDomain domain(test_config());
  const RosClock clock(domain, "/clock");
  RosSubscriptions subscriptions(
      domain, setup.topics, [&clock] { return clock.now(); },
      [&](RosArrival arrival) {
        const std::lock_guard lock(mutex);
        arrivals.push_back(std::move(arrival));
      });
  std::atomic<bool> is_over = false;
  std::thread player([&] {
    play(recording, {{"/odom", "nav_msgs/msg/Odometry"}}, 10);
    is_over = true;
  });
  std::vector<StampedPose<SE3>> rows;
  const auto read = [&] {
    subscriptions.look(host_time());
    std::unique_lock lock(mutex);
    auto arrived = std::exchange(arrivals, {});
    lock.unlock();
    for (RosArrival& arrival : arrived) samples.take(std::move(arrival));
    samples.advance(host_time());
    for (const Sample& sample : samples.take_samples())
      if (const auto* row = std::get_if<StampedPose<SE3>>(&sample)) rows.push_back(*row);
  };
  EXPECT_TRUE(becomes_true([&] {
    read();
    return is_over && rows.size() >= imported.imported.mission.robots.front().odometry.size();
  }));
  player.join();
  expect_odometry(rows, imported.imported.mission.robots.front().odometry);
}

}  // namespace
}  // namespace radioslam
