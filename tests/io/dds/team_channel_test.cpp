#include "radioslam/io/dds/team_channel.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <random>

#include "io/dds/dds_test_domain.hpp"

namespace radioslam {
namespace {

/// A robot, and what it has received.
class Robot {
 public:
  explicit Robot(const std::string& name)
      : domain_(test_config()), channel_(domain_, name, [this](TeamMessage message) {
          const std::lock_guard lock(mutex_);
          received_.push_back(std::move(message));
        }) {}
  TeamChannel& channel() { return channel_; }
  DdsDomain& domain() { return domain_; }
  std::vector<TeamMessage> received() const {
    const std::lock_guard lock(mutex_);
    return received_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<TeamMessage> received_;
  DdsDomain domain_;
  TeamChannel channel_;
};

bool see_each_other(std::initializer_list<Robot*> robots) {
  return becomes_true([&] {
    for (Robot* robot : robots)
      if (robot->channel().others() + 1 != robots.size()) return false;
    return true;
  });
}

std::size_t count(const Robot& robot, const std::string& octets) {
  std::size_t found = 0;
  for (const TeamMessage& message : robot.received()) found += message.octets == octets ? 1U : 0U;
  return found;
}

TEST(TeamMessageCdr, ComesBack) {
  const TeamMessage message{"a", "robot b", 255, std::string("\0\1\xff", 3)};
  const auto back = decode_team_message(encode_cdr(message));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->from, "a");
  EXPECT_EQ(back->to, "robot b");
  EXPECT_EQ(back->kind, 255);
  EXPECT_EQ(back->octets, message.octets);
}

TEST(TeamMessageCdr, AnyBytesAreRefusedOrRead) {
  const std::string whole = encode_cdr({"a", "b", 1, std::string(50, 'x')});
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_team_message(std::string_view(whole).substr(0, size))) << size;
  EXPECT_TRUE(decode_team_message(whole + std::string(3, '\0'))) << "padding of the wire";
  EXPECT_FALSE(decode_team_message(whole + std::string(4, '\0')));
  std::mt19937 random(1);
  for (int k = 0; k < 20'000; ++k) {
    std::string bytes = whole;
    for (int changes = k % 4; changes >= 0; --changes)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    const auto message = decode_team_message(bytes);
    EXPECT_TRUE(!message || message->octets.size() <= bytes.size());
  }
}

TEST(TeamChannel, ReachesAllOrOne) {
  Robot a("a"), b("b"), c("robot-c");
  EXPECT_FALSE(a.channel().send("nobody", 1, "x"));
  ASSERT_TRUE(see_each_other({&a, &b, &c}));
  ASSERT_TRUE(a.channel().send("", 1, "to all"));
  ASSERT_TRUE(becomes_true([&] { return count(b, "to all") == 1 && count(c, "to all") == 1; }));
  ASSERT_TRUE(
      becomes_true([&] { return a.channel().send("robot-c", 2, "to one") && count(c, "to one") > 0; }));
  ASSERT_TRUE(becomes_true([&] {
    return a.channel().send("", 3, "digest", TeamChannel::Delivery::kBestEffort) && count(b, "digest") > 0 &&
           count(c, "digest") > 0;
  }));
  EXPECT_EQ(b.received()[0].from, "a");
  EXPECT_EQ(b.received()[0].kind, 1);
  EXPECT_EQ(count(b, "to one"), 0u);
  EXPECT_TRUE(a.received().empty());
  for (Robot* robot : {&a, &b, &c}) EXPECT_TRUE(robot->domain().take_notes().empty());
}

TEST(TeamChannel, LargeMessagesArriveWhole) {
  Robot a("a"), b("b");
  ASSERT_TRUE(see_each_other({&a, &b}));
  std::string large(1'000'000, '\0');
  std::mt19937 random(1);
  for (char& c : large) c = static_cast<char>(random());
  ASSERT_TRUE(a.channel().send("", 1, large));
  ASSERT_TRUE(becomes_true([&] { return count(b, large) == 1; }));
}

TEST(TeamChannel, WhatIsNoMessageIsCounted) {
  Robot a("a");
  DdsDomain other(test_config());
  DdsWriter hostile(other, "rt/radioslam/team", "radioslam_msgs::msg::dds_::TeamMessage_");
  ASSERT_TRUE(becomes_true([&] { return hostile.matched() == 1 && a.channel().others() == 0; }));
  ASSERT_TRUE(becomes_true([&] {
    return hostile.write(std::string("\0\1\0\0\xff\xff\xff\xff", 8)) && a.channel().not_understood() > 0;
  }));
  EXPECT_TRUE(a.received().empty());
}

TEST(TeamChannel, AnotherRobotOfThisNameIsNoticed) {
  Robot a("a"), b("b"), namesake("a");
  ASSERT_TRUE(see_each_other({&a, &b, &namesake}));
  ASSERT_TRUE(a.channel().send("", 1, "x"));
  ASSERT_TRUE(becomes_true([&] { return namesake.channel().of_namesakes() == 1 && count(b, "x") == 1; }));
  EXPECT_TRUE(namesake.received().empty());
  EXPECT_EQ(a.channel().of_namesakes(), 0u);
}

/// With three of ten packets lost each way, what is sent at a pace that the writer can repeat arrives, in
/// order.
TEST(TeamChannel, ReliableMessagesSurviveLoss) {
  ::setenv("CYCLONEDDS_URI",
           "<CycloneDDS><Domain><Internal><Test><XmitLossiness>300</XmitLossiness></Test></Internal></Domain>"
           "</CycloneDDS>",
           1);
  Robot a("a"), b("b");
  ::unsetenv("CYCLONEDDS_URI");
  ASSERT_TRUE(see_each_other({&a, &b}));
  std::size_t reached = 0;  // a late reader may begin after the first ones
  ASSERT_TRUE(
      becomes_true([&] { return a.channel().send("", 0, "first") && (reached = b.received().size()) > 0; }));
  constexpr int kMessages = 50;
  const auto content = [](int k) {
    return std::string(static_cast<std::size_t>(k) * 250, static_cast<char>(k));
  };
  for (int k = 0; k < kMessages; ++k) {
    ASSERT_TRUE(a.channel().send("", 1, content(k)));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const auto messages = [&] {
    std::vector<std::string> found;
    for (const TeamMessage& message : b.received())
      if (message.kind == 1) found.push_back(message.octets);
    return found;
  };
  ASSERT_TRUE(becomes_true([&] { return messages().size() == kMessages; }, 60)) << messages().size();
  for (int k = 0; k < kMessages; ++k) EXPECT_TRUE(messages()[static_cast<std::size_t>(k)] == content(k)) << k;
}

}  // namespace
}  // namespace radioslam
