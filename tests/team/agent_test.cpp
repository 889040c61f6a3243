#include "radioslam/team/agent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

const RunParams& params() {
  static const RunParams of;
  return of;
}

std::unique_ptr<Agent> agent(const std::string& name, AgentParams of = {}) {
  auto made = std::make_unique<Agent>(name, 2, params(), of, AgentMemory{1, {}});
  FactsRecord facts;
  facts.lidar_range_m = facts.lidar_view_rad = 1;
  made->say(encode(Record(facts)));
  return made;
}

void drive(Agent& of, std::uint32_t number) {
  KeyframeRecord record;
  record.number = number;
  record.stamp = at(number);
  record.T_before_this = SE3({1, 0, 0}, Eigen::Quaterniond::Identity());
  of.say(encode(Record(record)));
}

ScanPyramid wall() {
  ScanPyramid scan;
  scan.median_range_m = 3;
  for (int k = 0; k < 20; ++k) {
    Surfel& surfel = scan.all.emplace_back();
    surfel.position = Eigen::Vector3f(3, 0.25F * static_cast<float>(k), 0);
  }
  return scan;
}

/// The agents' messages reach each other unless they are lost; a tenth of a second.
struct Air {
  std::vector<Agent*> agents;
  double loss = 0, now_s = 0;
  Rng random{3};
  std::size_t bytes = 0;
  std::vector<std::string> events = {};

  void tick() {
    now_s += 0.1;
    std::vector<std::pair<Agent*, SentMessage>> sent;
    for (Agent* of : agents) {
      of->note_kept();
      AgentStep step = of->step(at(now_s));
      for (SentMessage& message : step.messages) sent.emplace_back(of, std::move(message));
      for (const TeamEvent& event : step.events) events.push_back(of->name() + " " + event.what);
    }
    for (const auto& [from, message] : sent)
      for (Agent* to : agents) {
        if (to == from || (!message.to.empty() && message.to != to->name())) continue;
        bytes += message.bytes.size();
        if (random.uniform() >= loss) to->hear(from->name(), message.bytes, at(now_s));
      }
  }
  void run(double seconds) {
    for (const double end_s = now_s + seconds; now_s < end_s;) tick();
  }
};

TEST(Agent, KnowsWhatOthersSayThoughMostIsLost) {
  const auto a = agent("a"), b = agent("b"), c = agent("c");
  Air air{{a.get(), b.get(), c.get()}, 0.4};
  for (std::uint32_t k = 0; k < 60; ++k) {
    for (Agent* of : air.agents) drive(*of, k);
    air.run(1);
  }
  air.run(30);
  for (Agent* of : air.agents) {
    EXPECT_EQ(of->logs().extents(), a->logs().extents());
    EXPECT_EQ(of->logs().extents().at("b").records, 61U);
  }
}

TEST(Agent, RecordsReachThoseWhoDoNotHearTheRobotItself) {
  const auto a = agent("a"), b = agent("b"), c = agent("c");
  for (std::uint32_t k = 0; k < 20; ++k) drive(*a, k);
  Air first{{a.get(), b.get()}};
  first.run(5);
  Air then{{b.get(), c.get()}};
  then.now_s = first.now_s;
  then.run(5);
  EXPECT_EQ(c->logs().extents().at("a").records, 21U);
}

TEST(Agent, KeepsToItsBudget) {
  AgentParams slow;
  slow.bytes_s = 500;
  const auto a = agent("a", slow), b = agent("b");
  Air air{{a.get(), b.get()}};
  for (std::uint32_t k = 0; k < 400; ++k) drive(*a, k);
  std::size_t largest = 0;
  for (int second = 0; second < 10; ++second) {
    std::size_t bytes = 0;
    for (int k = 0; k < 10; ++k) {
      air.now_s += 0.1;
      a->note_kept();
      b->note_kept();
      for (const SentMessage& message : b->step(at(air.now_s)).messages)
        a->hear("b", message.bytes, at(air.now_s));
      for (const SentMessage& message : a->step(at(air.now_s)).messages) {
        bytes += message.bytes.size();
        b->hear("a", message.bytes, at(air.now_s));
      }
    }
    largest = std::max(largest, bytes);
  }
  EXPECT_LE(largest, 1050U);  // those of a second at once, and those of the second itself
  EXPECT_GT(b->logs().extents().at("a").records, 20U);
  air.run(60);
  EXPECT_EQ(b->logs().extents().at("a").records, 401U);  // late, not lost
}

TEST(Agent, RefusesInOneLineAndCounts) {
  const auto a = agent("a");
  Air air{{a.get()}};
  for (int k = 0; k < 50; ++k) a->hear("b", "nonsense", at(1));
  a->hear("b", encode("c", Digest{}), at(1));
  air.run(1);
  EXPECT_EQ(std::count_if(air.events.begin(), air.events.end(),
                          [](const auto& event) { return event.find("refuses") != std::string::npos; }),
            2);
  EXPECT_EQ(a->peers().at("b").refused.at("bytes that are no message"), 50U);
}

TEST(Agent, IsNotHarmedByHostileMessages) {
  const auto a = agent("a"), b = agent("b");
  Air air{{a.get(), b.get()}};
  Rng random(11);
  std::vector<std::string> heard;
  for (std::uint32_t k = 0; k < 20; ++k) {
    drive(*a, k);
    drive(*b, k);
    air.run(1);
    for (const SentMessage& message : b->step(at(air.now_s)).messages) heard.push_back(message.bytes);
    for (int trial = 0; trial < 200; ++trial) {
      std::string bytes;
      if (!heard.empty() && trial % 2 == 0) {
        bytes = heard[random.below(heard.size())];
        if (trial % 4 == 0) bytes = bytes.substr(0, random.below(bytes.size() + 1));
        for (int n = 0; n < 3 && !bytes.empty(); ++n)
          bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
      } else {
        for (std::uint64_t n = random.below(300); n > 0; --n) bytes += static_cast<char>(random.below(256));
      }
      a->hear("x", bytes, at(air.now_s));
    }
    // Records in b's name, and a digest of a log that nobody has.
    KnownLog lie{1, {{0, encode(Record(KeyframeRecord{}))}}};
    a->hear("x", encode("x", RecordsMessage{lie.bytes("b", 0, 1, 1000).first}), at(air.now_s));
    a->hear("x", encode("x", Digest{{{"b", {1, 1U << 30U}}, {"ghost", {9, 5}}}}), at(air.now_s));
  }
  air.run(10);
  EXPECT_EQ(a->logs().extents().at("b"), b->logs().extents().at("b"));
  EXPECT_EQ(b->logs().extents().at("a"), a->logs().extents().at("a"));
  EXPECT_EQ(a->logs().log("b").records.at(3), b->logs().log("b").records.at(3));
}

TEST(Agent, AnOlderCopyOfItsJournalBeginsAnotherLife) {
  const auto a = agent("a"), b = agent("b");
  for (std::uint32_t k = 0; k < 8; ++k) drive(*a, k);
  Air{{a.get(), b.get()}}.run(5);
  ASSERT_EQ(b->logs().extents().at("a").records, 9U);
  KnownLog copy{1, a->logs().log("a").records};
  copy.records.erase(copy.records.find(3), copy.records.end());
  Agent again("a", 2, params(), {}, AgentMemory{1, {{"a", copy}}, 7});
  for (std::uint32_t k = 2; k < 12; ++k) drive(again, 10 * k);
  Air air{{&again, b.get()}, 0, 6};
  air.run(10);
  EXPECT_EQ(b->logs().extents().at("a"), again.logs().extents().at("a"));
  EXPECT_EQ(again.logs().extents().at("a").life, 7U);
  EXPECT_EQ(b->logs().log("a").records, again.logs().log("a").records);
  again.hear("liar", encode("liar", Digest{{{"a", {8, 99}}}}), at(air.now_s));
  air.run(5);
  EXPECT_EQ(again.logs().extents().at("a").life, 7U);  // once
  EXPECT_EQ(again.peers().at("liar").refused.size(), 1U);
}

TEST(Agent, RemembersItsCloudsAndClosuresWhenItIsStartedAgain) {
  const auto a = agent("a");
  for (std::uint32_t k = 0; k < 4; ++k) drive(*a, k);
  ClosureRecord closure;
  closure.at = {3, at(3), SE3()};
  closure.other = "b";
  closure.stamp_other = at(1);
  a->say(encode(Record(closure)));
  a->set_scanner({ScannerKind::kPlanar, 0.75, 0.125});
  CloudStore clouds;
  a->add_cloud(at(2), clouds.add(wall()));
  const JournalChange change = a->change();
  ASSERT_EQ(change.state.size(), 1U);
  a->note_kept();
  EXPECT_TRUE(a->change().state.empty());

  const auto state = [&](const std::string& key) {
    const auto found = change.state.find(key);
    return found == change.state.end() ? std::nullopt : std::optional(found->second);
  };
  Agent again("a", 2, params(), {}, AgentMemory{1, {{"a", a->logs().log("a")}}, 7, state});
  EXPECT_EQ(again.clouds(), 1U);
  const auto before = a->scans().cloud(at(2)), after = again.scans().cloud(at(2));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->packed, after->packed);
  EXPECT_EQ(after->scanner.kind, ScannerKind::kPlanar);
  EXPECT_EQ(after->scanner.spacing_m, 0.125);
  EXPECT_TRUE(again.change().empty());  // nothing is kept twice
}

TEST(Agent, CloudsOfMoreThanASecondsBytesPassAndWhoWaitsIsSaid) {
  AgentParams slow;
  slow.bytes_s = 200;
  const auto a = agent("a", slow), b = agent("b");
  drive(*a, 0);
  CloudStore clouds;
  a->add_cloud(at(0), clouds.add(wall()));
  ASSERT_GT(a->scans().cloud(at(0))->packed.size(), 200U);
  Air air{{a.get(), b.get()}};
  air.run(5);
  a->hear("b", encode("b", CloudWant{{at(0)}}), at(air.now_s));
  const std::size_t before = air.bytes;
  air.run(20);
  EXPECT_GT(air.bytes - before, a->scans().cloud(at(0))->packed.size());
  for (std::uint32_t k = 1; k < 4000; ++k) drive(*a, k);  // which come before clouds
  air.run(2);
  a->hear("b", encode("b", CloudWant{{at(0)}}), at(air.now_s));
  air.run(100);
  EXPECT_EQ(std::count_if(air.events.begin(), air.events.end(),
                          [](const std::string& of) { return of.find("do not suffice") != of.npos; }),
            1);
}

TEST(Agent, OneThatDoesNotSolveTakesAnothersSolution) {
  AgentParams weak;
  weak.solves = false;
  const auto a = agent("a"), b = agent("b", weak);
  Air air{{a.get(), b.get()}};
  air.run(3);
  const SolutionMessage solution{7, {{"b", {"a", SE3({5, 0, 0}, Eigen::Quaterniond::Identity())}}}};
  b->hear("a", encode("a", solution), at(air.now_s));
  EXPECT_EQ(b->frame_of("b").frame, "a");
  b->hear("a", encode("a", SolutionMessage{3, {}}), at(air.now_s));  // an older one
  EXPECT_EQ(b->frame_of("b").frame, "a");
  a->hear("b", encode("b", solution), at(air.now_s));
  EXPECT_EQ(a->frame_of("b").frame, "b");  // it makes its own
}

}  // namespace
}  // namespace radioslam
