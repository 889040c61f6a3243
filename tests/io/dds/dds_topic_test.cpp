#include "radioslam/io/dds/dds_topic.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "io/dds/dds_samples.hpp"
#include "io/dds/dds_test_domain.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/io/dds/raw_type.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {
namespace {

class DdsTopic : public testing::Test {
 protected:
  DdsDomain a_{test_config()}, b_{test_config()};
};

TEST_F(DdsTopic, RobotsFindEachOtherWithoutMulticast) {
  EXPECT_TRUE(becomes_true([&] { return a_.others() == 1 && b_.others() == 1; }));
}

TEST_F(DdsTopic, AnOdometryFromTheWireIsReadAsFromARecording) {
  Received received;
  DdsReader reader(b_, "rt/odom", kOdometry, {}, received.take());
  DdsWriter writer(a_, "rt/odom", kOdometry);
  ASSERT_TRUE(becomes_true([&] { return writer.matched() == 1 && reader.matched() == 1; }));
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(writer.write(odometry_at(k)));
  ASSERT_TRUE(becomes_true([&] { return received.count() == 10; }));
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_TRUE(received.at(k).starts_with(odometry_at(static_cast<double>(k))));
    const RosPose pose = pose_of(received.at(k));
    EXPECT_EQ(pose.header.stamp, Stamp{100'000'000'005});
    EXPECT_EQ(pose.child, "base_link");
    ASSERT_TRUE(pose.pose);
    EXPECT_EQ(pose.pose->translation().x(), static_cast<double>(k));
  }
  EXPECT_TRUE(a_.take_notes().empty());
  EXPECT_TRUE(b_.take_notes().empty());
}

TEST_F(DdsTopic, WithoutACallbackSamplesWait) {
  DdsReader reader(b_, "rt/odom", kOdometry);
  DdsWriter writer(a_, "rt/odom", kOdometry);
  ASSERT_TRUE(becomes_true([&] { return writer.matched() == 1 && reader.matched() == 1; }));
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  ASSERT_TRUE(writer.write(odometry_at(7)));
  std::size_t count = 0;
  ASSERT_TRUE(becomes_true([&] {
    return (count += reader.take([&](const DdsReader::Sample& sample) {
             EXPECT_EQ(pose_of(std::string(sample.cdr)).pose->translation().x(), 7);
             EXPECT_GE(sample.sent, Stamp{std::chrono::nanoseconds(before).count()});
             EXPECT_NE(sample.writer, 0u);
           })) > 0;
  }));
  EXPECT_EQ(count, 1u);
}

class DdsCloud : public DdsTopic, public testing::WithParamInterface<DdsReliability> {};

TEST_P(DdsCloud, OfAMegabyteArrivesWhole) {
  const std::string sent = cloud(90'000);
  ASSERT_GT(sent.size(), 1'000'000u);
  DdsQos qos;
  qos.reliability = GetParam();
  Received received;
  DdsReader reader(b_, "rt/points", kCloud, qos, received.take());
  DdsWriter writer(a_, "rt/points", kCloud, qos);
  ASSERT_TRUE(becomes_true([&] { return writer.matched() == 1 && reader.matched() == 1; }));
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(writer.write(sent));
    ASSERT_TRUE(becomes_true([&] { return received.count() == k + 1; }));
    EXPECT_TRUE(received.at(k).starts_with(sent));
  }
  const RosChannel channel{"/points", "sensor_msgs/PointCloud2"};
  EXPECT_EQ(read_ros_scan({channel, Stamp{0}, received.at(0), "wire"}).scan.points.size(), 90'000u);
}

INSTANTIATE_TEST_SUITE_P(, DdsCloud, testing::Values(DdsReliability::kReliable, DdsReliability::kBestEffort),
                         [](const auto& tested) {
                           return tested.param == DdsReliability::kReliable ? "Reliable" : "BestEffort";
                         });

TEST_F(DdsTopic, ALateReaderGetsWhatATransientLocalWriterHasKept) {
  DdsQos qos;
  qos.durability = DdsDurability::kTransientLocal;
  DdsWriter writer(a_, "rt/map", kCloud, qos);
  for (std::size_t k = 0; k < 20; ++k) ASSERT_TRUE(writer.write(cloud(k)));
  Received received;
  const DdsReader reader(b_, "rt/map", kCloud, qos, received.take());
  ASSERT_TRUE(becomes_true([&] { return received.count() == 10; }));
  EXPECT_TRUE(received.at(0).starts_with(cloud(10)));
  EXPECT_TRUE(received.at(9).starts_with(cloud(19)));
}

TEST_F(DdsTopic, ARobotDoesNotReadItself) {
  Received own, other;
  const DdsReader own_reader(a_, "rt/odom", kOdometry, {}, own.take());
  const DdsReader other_reader(b_, "rt/odom", kOdometry, {}, other.take());
  DdsWriter writer(a_, "rt/odom", kOdometry);
  ASSERT_TRUE(becomes_true([&] { return writer.matched() >= 1 && other_reader.matched() == 1; }));
  ASSERT_TRUE(writer.write(odometry_at(1)));
  ASSERT_TRUE(becomes_true([&] { return other.count() == 1; }));
  EXPECT_EQ(own.count(), 0u);
}

TEST_F(DdsTopic, AnotherTypeIsNotedOnceByBoth) {
  const DdsReader reader(b_, "rt/odom", kOdometry);
  DdsWriter writer(a_, "rt/odom", dds_type("geometry_msgs/msg/PoseStamped"));
  std::vector<std::string> notes_of_reader, notes_of_writer;
  const auto gather = [](DdsDomain& domain, std::vector<std::string>& all) {
    for (auto& note : domain.take_notes()) all.push_back(note);
  };
  ASSERT_TRUE(becomes_true([&] {
    gather(b_, notes_of_reader);
    gather(a_, notes_of_writer);
    return !notes_of_reader.empty() && !notes_of_writer.empty();
  }));
  ASSERT_TRUE(writer.write(odometry_at(1)));
  for (int k = 0; k < 3; ++k) {
    gather(b_, notes_of_reader);
    gather(a_, notes_of_writer);
  }
  EXPECT_EQ(notes_of_reader,
            std::vector<std::string>{
                "DDS: topic /odom: a publisher sends geometry_msgs/msg/PoseStamped, this robot "
                "reads nav_msgs/msg/Odometry; nothing passes"});
  EXPECT_EQ(notes_of_writer,
            std::vector<std::string>{
                "DDS: topic /odom: this robot sends geometry_msgs/msg/PoseStamped, a subscriber "
                "reads nav_msgs/msg/Odometry; nothing passes"});
  EXPECT_EQ(writer.matched(), 0u);
}

TEST_F(DdsTopic, AnotherQosIsNotedWithBoth) {
  DdsQos best_effort;
  best_effort.reliability = DdsReliability::kBestEffort;
  const DdsReader reader(b_, "rt/odom", kOdometry);
  const DdsWriter writer(a_, "rt/odom", kOdometry, best_effort);
  std::vector<std::string> notes;
  ASSERT_TRUE(becomes_true([&] { return !(notes = b_.take_notes()).empty(); }));
  EXPECT_EQ(notes, std::vector<std::string>{
                       "DDS: topic /odom: reliability: a publisher offers best effort, this robot "
                       "asks for reliable; nothing passes"});
  EXPECT_EQ(writer.matched(), 0u);
}

TEST_F(DdsTopic, AnnouncesItsTopicsWithRos2sNamesAndDefaults) {
  const DdsWriter writer(a_, "rt/odom", kOdometry);
  const auto is_announced = [&] {
    for (const DdsEndpoint& found : b_.writers())
      if (!found.is_own && found.topic == "rt/odom" && found.type == "nav_msgs::msg::dds_::Odometry_" &&
          found.reliability == DdsReliability::kReliable && found.durability == DdsDurability::kVolatile)
        return true;
    return false;
  };
  EXPECT_TRUE(becomes_true(is_announced));
}

/// Whatever arrives in plain CDR is handed on; the readers of messages refuse it, or not, but never crash.
TEST_F(DdsTopic, RandomContentsDoNoHarm) {
  Received received;
  DdsQos deep;
  deep.depth = 1000;
  const DdsReader reader(b_, "rt/odom", kOdometry, deep, received.take());
  DdsWriter writer(a_, "rt/odom", kOdometry, deep);
  ASSERT_TRUE(becomes_true([&] { return writer.matched() == 1 && reader.matched() == 1; }));
  std::mt19937 random(1);
  std::vector<std::string> sent;
  for (std::size_t k = 0; k < 500; ++k) {
    std::string bytes(4 + (k < 40 ? k : random() % 3000), '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    bytes[0] = 0;
    bytes[1] &= 1;
    ASSERT_TRUE(writer.write(bytes));
    sent.push_back(std::move(bytes));
  }
  ASSERT_TRUE(becomes_true([&] { return received.count() == sent.size(); })) << received.count();
  std::size_t refused = 0;
  for (std::size_t k = 0; k < sent.size(); ++k) {
    ASSERT_TRUE(received.at(k).starts_with(sent[k]));
    ASSERT_LT(received.at(k).size(), sent[k].size() + 4);
    try {
      pose_of(received.at(k));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 400u);
}

/// Cyclone's reader holds what is no CDR for a damaged packet and asks for it again: such a writer loses all
/// that it sends later, nobody else anything.
TEST_F(DdsTopic, AWriterOfAnotherEncapsulationHarmsItselfAloneAndIsNoted) {
  Received received;
  const DdsReader reader(b_, "rt/odom", kOdometry, {}, received.take());
  DdsDomain hostile(test_config());
  ddsi_sertype* type = make_raw_type(kOdometry);
  const dds_entity_t topic =
      dds_create_topic_sertype(hostile.participant(), "rt/odom", &type, nullptr, nullptr, nullptr);
  const dds_entity_t bad = dds_create_writer(hostile.participant(), topic, nullptr, nullptr);
  DdsWriter good(a_, "rt/odom", kOdometry);
  ASSERT_TRUE(becomes_true([&] { return good.matched() == 1 && reader.matched() == 2; }));
  ASSERT_TRUE(becomes_true([&] {
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(bad, &status) == DDS_RETCODE_OK && status.current_count >= 1;
  }));
  for (const std::string bytes : {"\x77\x55\x33\x11 and more", "\x77\x55\x33\x11", "\x77", ""})
    EXPECT_EQ(dds_writecdr(bad, make_raw_sample(type, bytes)), DDS_RETCODE_OK);
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(good.write(odometry_at(k)));
  EXPECT_TRUE(becomes_true([&] { return received.count() >= 10; }));
  std::vector<std::string> notes;
  ASSERT_TRUE(becomes_true([&] { return !(notes = b_.take_notes()).empty(); }));
  EXPECT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("malformed packet received"), std::string::npos) << notes[0];
  EXPECT_EQ(notes[0].find('<'), std::string::npos) << notes[0];
}

TEST(DdsConfig, WhatCycloneRefusesIsRefusedWithItsReason) {
  DdsConfig config = test_config();
  config.interface = "none0";
  const std::string line = refusal([&] { const DdsDomain domain(config); });
  EXPECT_NE(line.find("DDS domain"), std::string::npos);
  EXPECT_NE(line.find("none0"), std::string::npos) << line;
  config = test_config();
  config.domain = 233;
  expect_refusal([&] { const DdsDomain domain(config); }, 0, "the domain must be at most 232");
}

/// In a process of its own, which checks no leaks: Cyclone loses 240 bytes when it finds no free number.
TEST(DdsConfig, MoreRobotsThanAreLookedForAtAnAddressAreRefused) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto enter_three_times = [] {
    DdsConfig config = test_config();
    config.robots_per_host = 2;
    const DdsDomain a(config), b(config);
    try {
      const DdsDomain c(config);
    } catch (const InputError& error) {
      std::fputs(error.what(), stderr);
      ::_exit(2);
    }
    ::_exit(0);
  };
  EXPECT_EXIT(enter_three_times(), testing::ExitedWithCode(2), "robots of this host: at most 2");
}

TEST(DdsConfig, ManyTopicsAreAllKnown) {
  DdsDomain a(test_config());
  DdsDomain b(test_config());
  std::vector<std::unique_ptr<DdsWriter>> writers;
  for (int k = 0; k < 600; ++k)
    writers.push_back(std::make_unique<DdsWriter>(a, "rt/topic" + std::to_string(k), kOdometry));
  EXPECT_EQ(a.writers().size(), 600u);
  EXPECT_TRUE(becomes_true([&] { return b.writers().size() == 600; }));
  writers.resize(10);
  EXPECT_TRUE(becomes_true([&] { return b.writers().size() == 10; }));
}

TEST(DdsConfig, TheUsersCycloneddsUriPrevailsAndIsNoted) {
  ::setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><General><Nonsense/></General></Domain></CycloneDDS>", 1);
  const std::string line = refusal([] { const DdsDomain domain(test_config()); });
  EXPECT_NE(line.find("Nonsense"), std::string::npos) << line;
  ::setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><Discovery><Tag>x</Tag></Discovery></Domain></CycloneDDS>",
           1);
  DdsDomain with_tag(test_config());
  ::unsetenv("CYCLONEDDS_URI");
  DdsDomain without(test_config());
  EXPECT_EQ(with_tag.take_notes(),
            std::vector<std::string>{
                "DDS: CYCLONEDDS_URI is set; where it differs from this program, it prevails"});
  EXPECT_FALSE(becomes_true([&] { return without.others() > 0; }, 1)) << "robots of another tag are not seen";
}

TEST(DdsConfig, ARobotThatCannotFindAnybodyKnows) {
  DdsConfig config = test_config();
  config.peers.clear();
  DdsDomain domain(config);
  EXPECT_EQ(domain.take_notes(),
            std::vector<std::string>{
                "DDS: no peers are listed and multicast is off; this robot finds nobody by itself"});
}

}  // namespace
}  // namespace radioslam
