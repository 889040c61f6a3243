// What this project's DDS says and reads is that of another vendor, under the names of ROS 2.
#include <gtest/gtest.h>

#ifdef RADIOSLAM_HAS_FAST_DDS

#include "io/dds/dds_samples.hpp"
#include "io/dds/dds_test_domain.hpp"
#include "io/dds/fast_dds_peer.hpp"

namespace radioslam {
namespace {

class FastDds : public testing::Test {
 protected:
  void expect_to_read(const std::string& topic, const std::string& type,
                      const std::vector<std::string>& sent) {
    Received received;
    const DdsReader reader(robot_, topic, type, {}, received.take());
    peer_.open_writer(topic, type);
    ASSERT_TRUE(becomes_true([&] { return reader.matched() == 1 && peer_.matched() == 1; }));
    // A volatile reader may begin after what the writer's first heartbeat announces, though it is still on
    // its way.
    std::size_t first = 0;
    ASSERT_TRUE(becomes_true([&] { return peer_.write(sent[0]) && (first = received.count()) > 0; }));
    const std::string last = sent.back() + "the last one before";
    ASSERT_TRUE(peer_.write(last));
    ASSERT_TRUE(becomes_true([&] { return received.at((first = received.count()) - 1).starts_with(last); }));
    for (const std::string& bytes : sent) ASSERT_TRUE(peer_.write(bytes));
    ASSERT_TRUE(becomes_true([&] { return received.count() == first + sent.size(); }))
        << received.count() - first;
    for (std::size_t k = 0; k < sent.size(); ++k)
      EXPECT_TRUE(received.at(first + k).starts_with(sent[k])) << k;
  }
  void expect_to_be_read(const std::string& topic, const std::string& type,
                         const std::vector<std::string>& sent) {
    peer_.open_reader(topic, type);
    DdsWriter writer(robot_, topic, type);
    ASSERT_TRUE(becomes_true([&] { return writer.matched() == 1 && peer_.matched() == 1; }));
    for (const std::string& bytes : sent) ASSERT_TRUE(writer.write(bytes));
    ASSERT_TRUE(becomes_true([&] { return peer_.received().size() == sent.size(); }))
        << peer_.received().size();
    for (std::size_t k = 0; k < sent.size(); ++k) EXPECT_TRUE(peer_.received()[k].starts_with(sent[k])) << k;
  }
  static std::vector<std::string> odometry() {
    std::vector<std::string> messages;
    for (int k = 0; k < 10; ++k) messages.push_back(odometry_at(k));
    return messages;
  }

  DdsDomain robot_{test_config()};
  FastDdsPeer peer_{test_domain()};
};

TEST_F(FastDds, ItsOdometryIsRead) { expect_to_read("rt/odom", kOdometry, odometry()); }

TEST_F(FastDds, ReadsThisOdometry) { expect_to_be_read("rt/odom", kOdometry, odometry()); }

TEST_F(FastDds, ItsCloudOfAMegabyteIsRead) {
  expect_to_read("rt/points", kCloud, {cloud(90'000), cloud(90'001)});
}

TEST_F(FastDds, ReadsThisCloudOfAMegabyte) {
  expect_to_be_read("rt/points", kCloud, {cloud(90'000), cloud(90'001)});
}

TEST_F(FastDds, ReadsTransforms) {
  RosBytes tf(MessageEncoding::kCdr);
  tf.u32(1).header(100, 5, "map").text("a/odom").f64s({1, 2, 3, 0, 0, 0, 1});
  expect_to_be_read("rt/tf", dds_type("tf2_msgs/msg/TFMessage"), {tf.bytes()});
}

TEST_F(FastDds, AnotherTypeOfItsIsNoted) {
  const DdsReader reader(robot_, "rt/odom", kOdometry);
  peer_.open_writer("rt/odom", dds_type("geometry_msgs/msg/PoseStamped"));
  std::vector<std::string> notes;
  ASSERT_TRUE(becomes_true([&] { return !(notes = robot_.take_notes()).empty(); }));
  EXPECT_EQ(notes, std::vector<std::string>{
                       "DDS: topic /odom: a publisher sends geometry_msgs/msg/PoseStamped, this "
                       "robot reads nav_msgs/msg/Odometry; nothing passes"});
}

TEST_F(FastDds, AnotherQosOfItsIsNoted) {
  DdsQos kept;
  kept.durability = DdsDurability::kTransientLocal;
  const DdsWriter writer(robot_, "rt/odom", kOdometry, kept);
  const DdsReader reader(robot_, "rt/map", kOdometry, kept);
  peer_.open_reader("rt/odom", kOdometry);
  peer_.open_writer("rt/map", kOdometry);
  ASSERT_TRUE(becomes_true([&] { return writer.matched() == 1; })) << "it asks for less than is offered";
  std::vector<std::string> notes;
  ASSERT_TRUE(becomes_true([&] { return !(notes = robot_.take_notes()).empty(); }));
  EXPECT_EQ(notes, std::vector<std::string>{
                       "DDS: topic /map: durability: a publisher offers volatile, this robot asks "
                       "for transient local; nothing passes"});
}

}  // namespace
}  // namespace radioslam

#else

TEST(FastDds, Missing) { GTEST_SKIP() << "libfastrtps-dev was not there when the tests were built"; }

#endif
