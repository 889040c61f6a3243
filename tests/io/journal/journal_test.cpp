#include "radioslam/io/journal/journal.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"

namespace radioslam {
namespace {

using Records = std::map<std::uint64_t, std::string>;

/// A journal of robot a, opened again each time.
class JournalTest : public testing::Test {
 protected:
  Journal open(std::uint32_t life_if_new = 7) const { return {file_, "a", life_if_new}; }
  void commit(const JournalChange& change) const { open().commit(change); }
  /// The records of one robot and life.
  Records records(const std::string& robot, std::uint32_t life) const {
    for (const auto& [name, log] : open().logs())
      if (name == robot && log.life == life) return log.records;
    return {};
  }
  static JournalChange own(std::uint64_t first, std::vector<std::string> records) {
    JournalChange change;
    change.first_own = first;
    change.own = std::move(records);
    return change;
  }
  static JournalChange kept(const std::string& robot, std::uint32_t life, std::uint64_t first,
                            std::vector<std::string> records) {
    JournalChange change;
    change.kept.push_back({robot, life, first, std::move(records)});
    return change;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "a.journal";
};

TEST_F(JournalTest, ANewOneHasTheLifeGivenAndKeepsIt) {
  EXPECT_TRUE(open(7).is_new());
  const Journal again = open(8);
  EXPECT_FALSE(again.is_new());
  EXPECT_EQ(again.life(), 7u);
  EXPECT_EQ(again.own_records(), 0u);
  EXPECT_TRUE(again.logs().empty());
}

TEST_F(JournalTest, GivesBackWhatWasCommitted) {
  const std::string any_bytes{"\0\xff'\"\n", 5};
  JournalChange change = own(0, {"first", any_bytes});
  change.kept = {
      {"b", 4'000'000'000u, 5, {"b5", "b6"}}, {"c", 1, 0, {"c0"}}, {"a", 3, 9, {"of an earlier life"}}};
  change.state = {{"clock", any_bytes}, {"nothing", ""}};
  commit(change);
  commit(own(2, {"third"}));

  EXPECT_EQ(open().own_records(), 3u);
  EXPECT_EQ(records("a", 7), (Records{{0, "first"}, {1, any_bytes}, {2, "third"}}));
  EXPECT_EQ(records("a", 3), (Records{{9, "of an earlier life"}}));
  EXPECT_EQ(records("b", 4'000'000'000u), (Records{{5, "b5"}, {6, "b6"}}));
  EXPECT_EQ(records("c", 1), (Records{{0, "c0"}}));
  EXPECT_EQ(open().state("clock"), any_bytes);
  EXPECT_EQ(open().state("nothing"), "");
  EXPECT_EQ(open().state("unknown"), std::nullopt);
}

TEST_F(JournalTest, StateIsReplaced) {
  JournalChange change;
  change.state = {{"frame", "old"}, {"clock", "1"}};
  commit(change);
  change.state = {{"frame", "new"}};
  commit(change);
  EXPECT_EQ(open().state("frame"), "new");
  EXPECT_EQ(open().state("clock"), "1");
}

TEST_F(JournalTest, TheSameAgainChangesNothing) {
  commit(own(0, {"x", "y"}));
  commit(own(1, {"y", "z"}));
  commit(kept("b", 1, 3, {"b3"}));
  commit(kept("b", 1, 2, {"b2", "b3", "b4"}));
  EXPECT_EQ(records("a", 7), (Records{{0, "x"}, {1, "y"}, {2, "z"}}));
  EXPECT_EQ(records("b", 1), (Records{{2, "b2"}, {3, "b3"}, {4, "b4"}}));
}

TEST_F(JournalTest, ARecordHasOneContent) {
  commit(own(0, {"x", "y"}));
  commit(kept("b", 1, 0, {"b0"}));
  expect_refusal([&] { commit(own(1, {"other"})); }, 0, "record 1 of robot a is known with other contents");
  expect_refusal([&] { commit(kept("b", 1, 0, {"other"})); }, 0,
                 "record 0 of robot b is known with other contents");
  EXPECT_EQ(records("a", 7), (Records{{0, "x"}, {1, "y"}}));
  EXPECT_EQ(records("b", 1), (Records{{0, "b0"}}));
}

TEST_F(JournalTest, OwnRecordsHaveNoGapAndComeFromTheRobotAlone) {
  commit(own(0, {"x"}));
  expect_refusal([&] { commit(own(2, {"z"})); }, 0, "record 2 would leave a gap behind the 1 that are known");
  expect_refusal([&] { commit(kept("a", 7, 1, {"y"})); }, 0,
                 "record 1 of robot a is its own, but not from it");
  EXPECT_EQ(records("a", 7), (Records{{0, "x"}}));
}

TEST_F(JournalTest, OfARefusedChangeNothingIsKeptAndTheJournalGoesOn) {
  Journal journal = open();
  journal.commit(own(0, {"x"}));
  JournalChange bad = own(1, {"y"});
  bad.forgotten = {"a", "b"};
  bad.kept = {{"b", 1, 0, {"b0"}}, {"c", 1, 0, {"c0"}}, {"c", 1, 0, {"other"}}};
  bad.state = {{"k", "v"}};
  expect_refusal([&] { journal.commit(bad); }, 0, "record 0 of robot c");
  EXPECT_EQ(journal.own_records(), 1u);
  EXPECT_EQ(journal.logs().size(), 1u);
  EXPECT_EQ(journal.state("k"), std::nullopt);
  journal.commit(own(1, {"another y"}));
  EXPECT_EQ(journal.logs()[0].second.records, (Records{{0, "x"}, {1, "another y"}}));
}

TEST_F(JournalTest, AForgottenRobotMayHaveAnotherRecording) {
  JournalChange change = own(0, {"x"});
  change.kept = {{"a", 3, 0, {"earlier"}}, {"b", 1, 0, {"b0"}}, {"c", 1, 0, {"c0"}}};
  commit(change);
  change = kept("b", 2, 0, {"again b0"});
  change.forgotten = {"a", "b"};
  commit(change);
  EXPECT_EQ(records("a", 7), (Records{{0, "x"}}));
  EXPECT_TRUE(records("a", 3).empty());
  EXPECT_TRUE(records("b", 1).empty());
  EXPECT_EQ(records("b", 2), (Records{{0, "again b0"}}));
  EXPECT_EQ(records("c", 1), (Records{{0, "c0"}}));
}

TEST_F(JournalTest, AnotherLifeReplacesTheLastOneAtOnce) {
  JournalChange change = own(0, {"x", "y"});
  change.kept = {{"b", 1, 0, {"b0"}}};
  commit(change);
  change = own(0, {"x", "other y", "z"});
  change.life = 9;
  Journal journal = open();
  journal.commit(change);
  EXPECT_EQ(journal.life(), 9u);
  EXPECT_EQ(journal.own_records(), 3u);
  expect_refusal([&] { journal.commit(change); }, 0, "life 9 does not follow 9");
}

TEST_F(JournalTest, ManyRecordsAtOnce) {
  std::vector<std::string> many;
  Records expected;
  for (std::uint64_t k = 0; k < 20'000; ++k) {
    many.push_back(std::string(k % 700, static_cast<char>(k)));
    expected[k] = many.back();
  }
  commit(own(0, many));
  commit(kept("b", 1, 0, many));
  EXPECT_EQ(records("a", 7), expected);
  EXPECT_EQ(records("b", 1), expected);
}

}  // namespace
}  // namespace radioslam
