#include "radioslam/team/messages.hpp"

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

std::vector<std::string> one_of_each() {
  Digest digest{{{"a", {7, 120, 5}}, {"bravo", {1, 0}}}, false};
  Want want{{{"a", 7, 5, 9}, {"c", 1, 0, 100000}}};
  CloudMessage cloud{Stamp::from_seconds(12.5), {ScannerKind::kPlanar, 0.8, 0.2}, "packed"};
  SolutionMessage solution{42, {{"a", {"b", SE3({1, 2, 3}, Eigen::Quaterniond(0.6, 0, 0, 0.8))}}}};
  return {encode("a", digest), encode("a", RecordsMessage{"any bytes"}),
          encode("a", want),   encode("a", CloudWant{{Stamp::from_seconds(1), Stamp::from_seconds(2)}}),
          encode("a", cloud),  encode("a", solution)};
}

template <class Kind>
Kind received(const std::string& bytes) {
  const auto decoded = decode_message(bytes);
  return std::get<Kind>(std::get<ReceivedMessage>(decoded).message);
}

TEST(AgentMessages, AreReadAsTheyWereSaid) {
  const auto all = one_of_each();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto decoded = decode_message(all[k]);
    const auto* message = std::get_if<ReceivedMessage>(&decoded);
    ASSERT_NE(message, nullptr) << kAgentMessageKinds[k];
    EXPECT_EQ(message->sender, "a");
    EXPECT_EQ(encode(message->sender, message->message), all[k]);
  }
  EXPECT_EQ(received<Digest>(all[0]).knows.at("a"), (LogExtent{7, 120, 5}));
  EXPECT_FALSE(received<Digest>(all[0]).solves);
  EXPECT_EQ(received<Want>(all[2]).stretches[1], (WantedStretch{"c", 1, 0, 100000}));
  EXPECT_EQ(received<CloudWant>(all[3]).keyframes[1], Stamp::from_seconds(2));
  EXPECT_EQ(received<CloudMessage>(all[4]).scanner.kind, ScannerKind::kPlanar);
  const PublishedFrame frame = received<SolutionMessage>(all[5]).frames.at("a");
  EXPECT_EQ(frame.frame, "b");
  EXPECT_LT((frame.T_frame_start.translation() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(AgentMessages, TruncatedOrWithMoreBytesAreRefused) {
  for (const std::string& bytes : one_of_each()) {
    const std::size_t kind = static_cast<unsigned char>(bytes[4]);
    const bool has_free_end = kind == 1 || kind == 4;  // what follows is looked at by whoever takes it
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto decoded = decode_message(std::string_view(bytes).substr(0, size));
      if (!has_free_end) {
        EXPECT_TRUE(std::holds_alternative<std::string>(decoded)) << kind << ' ' << size;
      }
    }
    if (!has_free_end) {
      EXPECT_TRUE(std::holds_alternative<std::string>(decode_message(bytes + "x"))) << kind;
    }
  }
}

TEST(AgentMessages, ADigestOfMoreRecordsThanCanBeAskedForIsRefused) {
  const auto is_read = [](std::uint64_t records) {
    return std::holds_alternative<ReceivedMessage>(
        decode_message(encode("a", Digest{{{"b", {1, records}}}})));
  };
  EXPECT_TRUE(is_read(std::uint64_t{1} << 40U));
  EXPECT_FALSE(is_read((std::uint64_t{1} << 40U) + 1));
}

TEST(AgentMessages, OtherVersionsAndTooManyBytesAreNamed) {
  std::string bytes = one_of_each()[0];
  bytes[3] = '2';
  EXPECT_EQ(std::get<std::string>(decode_message(bytes)),
            "messages of another version of this program; a team needs one");
  EXPECT_EQ(std::get<std::string>(decode_message("hello")), "bytes that are no message");
  EXPECT_NE(std::get<std::string>(decode_message(std::string(kMaxAgentMessageBytes + 1, 'x'))).find("60,000"),
            std::string::npos);
}

TEST(AgentMessages, AnyChangedByteIsReadOrRefused) {
  Rng random(5);
  for (const std::string& bytes : one_of_each())
    for (int trial = 0; trial < 2000; ++trial) {
      std::string changed = bytes;
      for (int k = 0; k < 3; ++k)
        changed[random.below(changed.size())] = static_cast<char>(random.below(256));
      const auto decoded = decode_message(changed);
      if (const auto* message = std::get_if<ReceivedMessage>(&decoded)) {
        EXPECT_TRUE(std::holds_alternative<ReceivedMessage>(
            decode_message(encode(message->sender, message->message))));
      }
    }
}

}  // namespace
}  // namespace radioslam
