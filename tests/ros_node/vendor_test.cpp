// Drivers and viewers of another vendor's DDS: their messages become samples, and read what is published.
#include <gtest/gtest.h>

#ifdef RADIOSLAM_HAS_FAST_DDS

#include <mutex>

#include "io/dds/dds_test_domain.hpp"
#include "io/dds/fast_dds_peer.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/ros_node/ros_publisher.hpp"
#include "radioslam/ros_node/ros_subscriptions.hpp"
#include "ros_node/arrivals.hpp"

namespace radioslam {
namespace {

TEST(OtherVendor, ItsOdometryCloudsAndTransformsBecomeSamples) {
  RobotSamplesSetup setup;
  setup.names.robots.emplace_back().id = "a";
  setup.self = RobotIndex(0);
  setup.topics = robot_topics("/a", {});
  RobotSamples samples(setup);
  std::mutex mutex;
  std::vector<RosArrival> arrivals;
  DdsDomain domain(test_config());
  RosSubscriptions subscriptions(domain, setup.topics, host_time, [&](RosArrival arrival) {
    const std::lock_guard lock(mutex);
    arrivals.push_back(std::move(arrival));
  });
  FastDdsPeer odometry(test_domain()), lidar(test_domain()), transforms(test_domain());
  transforms.open_writer("rt/tf_static", dds_type("tf2_msgs/msg/TFMessage"), true);
  const SE3 T_body_lidar({0, 0, 1}, Eigen::Quaterniond::Identity());
  ASSERT_TRUE(transforms.write(transforms_cdr({{{}, "base_link", "lidar", T_body_lidar}})));
  odometry.open_writer("rt/a/odom", dds_type("nav_msgs/msg/Odometry"));
  lidar.open_writer("rt/a/points", dds_type("sensor_msgs/msg/PointCloud2"));
  ASSERT_TRUE(becomes_true([&] {
    subscriptions.look(host_time());
    return odometry.matched() == 1 && lidar.matched() == 1 && transforms.matched() == 1;
  }));
  std::vector<MapPoint> points(10'000);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].position = {static_cast<float>(k), 1, 2};
    points[k].intensity = static_cast<float>(k % 7);
  }
  std::vector<StampedPose<SE3>> rows;
  std::vector<ScanSample> scans;
  EXPECT_TRUE(becomes_true([&] {
    const Stamp now = host_time();
    odometry.write(odometry_message(now, SE3({3, 0, 0}, Eigen::Quaterniond::Identity())));
    lidar.write(cloud_cdr({now, "lidar"}, points));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::unique_lock lock(mutex);
    auto arrived = std::exchange(arrivals, {});
    lock.unlock();
    for (RosArrival& arrival : arrived) samples.take(std::move(arrival));
    samples.advance(host_time());
    for (Sample& sample : samples.take_samples()) {
      if (const auto* row = std::get_if<StampedPose<SE3>>(&sample)) rows.push_back(*row);
      if (auto* scan = std::get_if<ScanSample>(&sample)) scans.push_back(std::move(*scan));
    }
    return rows.size() > 20 && scans.size() > 20;
  }));
  ASSERT_FALSE(scans.empty());
  EXPECT_EQ(samples.take_notes(),
            std::vector<std::string>{"measures by /a/odom, /a/points in the frame base_link"});
  EXPECT_LT(rows.front().pose.log().norm(), 1e-9);
  ASSERT_EQ(scans.back().scan.points.size(), points.size());
  EXPECT_EQ(scans.back().scan.points[9'999], Eigen::Vector3f(9999, 1, 3));  // a metre above the body
  EXPECT_EQ(scans.back().scan.intensities[9'999], 9'999 % 7);
}

TEST(OtherVendor, ReadsOdometryCloudsAndTransformsThatArePublished) {
  DdsDomain domain(test_config());
  DdsSink sink(domain, {{"/a/radioslam/odom", "nav_msgs/msg/Odometry"},
                        {"/a/radioslam/map", "sensor_msgs/msg/PointCloud2", true},
                        {"/tf", "tf2_msgs/msg/TFMessage"}});
  RosPublisher publisher;
  publisher.add(sink);
  const SE3 pose({1, 2, 3}, Eigen::Quaterniond::Identity());
  std::vector<MapPoint> points(20'000);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].position.x() = static_cast<float>(k);
  const std::vector<RosPublication> publications{
      {"/a/radioslam/odom", "nav_msgs/msg/Odometry", "", at(5),
       odometry_cdr({at(5), "a/odom", "a/base_link", pose})},
      {"/a/radioslam/map", "sensor_msgs/msg/PointCloud2", "", at(5), cloud_cdr({at(5), "a/map"}, points)},
      {"/tf", "tf2_msgs/msg/TFMessage", "", at(5), transforms_cdr({{at(5), "a/map", "a/odom", pose}})}};
  for (const RosPublication& publication : publications) {
    FastDdsPeer viewer(test_domain());
    viewer.open_reader(dds_topic(publication.topic), dds_type(publication.type));
    ASSERT_TRUE(becomes_true([&] { return publisher.wants(publication.topic) && viewer.matched() == 1; }))
        << publication.topic;
    publisher.publish(publication);
    ASSERT_TRUE(becomes_true([&] { return viewer.received().size() == 1; })) << publication.topic;
    EXPECT_TRUE(viewer.received()[0].starts_with(publication.cdr)) << publication.topic;
  }
}

}  // namespace
}  // namespace radioslam

#else

TEST(OtherVendor, Missing) { GTEST_SKIP() << "libfastrtps-dev was not there when the tests were built"; }

#endif
