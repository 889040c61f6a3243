// Messages that robots have recorded arrive as they are in the recording, in whatever type, and so are read
// as there.
#include <gtest/gtest.h>

#include <map>

#include "io/dds/dds_samples.hpp"
#include "io/dds/dds_test_domain.hpp"
#include "io/recorded_data.hpp"
#include "radioslam/io/ros/ros_recording.hpp"

namespace radioslam {
namespace {

/// A topic on its way from one robot to another.
struct Passing {
  Received received;
  std::vector<std::string> sent;
  std::unique_ptr<DdsReader> reader;
  std::unique_ptr<DdsWriter> writer;
};

void expect_to_pass(const std::filesystem::path& recording) {
  DdsDomain a(test_config()), b(test_config());
  std::map<std::string, std::unique_ptr<Passing>> topics;
  DdsQos deep;
  deep.depth = 200;
  const auto take = [&](const RosMessage& message) {
    auto& passing = topics[message.channel.topic];
    if (!passing) {
      passing = std::make_unique<Passing>();
      const std::string topic = dds_topic(message.channel.topic), type = dds_type(message.channel.type);
      passing->reader = std::make_unique<DdsReader>(b, topic, type, deep, passing->received.take());
      passing->writer = std::make_unique<DdsWriter>(a, topic, type, deep);
      ASSERT_TRUE(
          becomes_true([&] { return passing->writer->matched() == 1 && passing->reader->matched() == 1; }));
    }
    ASSERT_TRUE(passing->writer->write(message.bytes));
    passing->sent.emplace_back(message.bytes);
    ASSERT_TRUE(becomes_true([&] { return passing->received.count() + 100 > passing->sent.size(); }));
  };
  visit_recording(recording, {[](const RosChannel&) { return true; }, take});
  std::size_t messages = 0;
  for (const auto& entry : topics) {
    const std::string& topic = entry.first;
    Passing* const passing = entry.second.get();
    const auto& sent = passing->sent;
    ASSERT_TRUE(becomes_true([&] { return passing->received.count() == sent.size(); })) << topic;
    for (std::size_t k = 0; k < sent.size(); ++k) {
      ASSERT_TRUE(passing->received.at(k).starts_with(sent[k])) << topic << ", message " << k;
      ASSERT_LT(passing->received.at(k).size(), sent[k].size() + 4) << topic;
    }
    messages += sent.size();
  }
  EXPECT_GT(messages, 0u);
  testing::Test::RecordProperty("messages", static_cast<int>(messages));
}

TEST(DdsRecordings, OfANavigatingRobotPass) {
  RADIOSLAM_RECORDED(recording, "ros_logs/nav2_turtlebot.mcap");
  expect_to_pass(recording);
}

TEST(DdsRecordings, OfTransformsPass) {
  RADIOSLAM_RECORDED(recording, "ros_logs/tf_example");
  expect_to_pass(recording);
}

TEST(DdsRecordings, OfATeamWithLidarPass) {
  RADIOSLAM_RECORDED(recording, "tiers/shortbag.db3");
  expect_to_pass(recording);
}

}  // namespace
}  // namespace radioslam
