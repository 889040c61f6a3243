#include "radioslam/live/stream_effort.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

KnownCounts known(std::size_t keyframes, std::size_t links = 0) {
  return {.records = keyframes + links, .keyframes = keyframes, .links = links};
}

/// A team that was aligned at 100 s.
EffortState aligned(const KnownCounts& then) {
  EffortState state;
  state.note(Effort::kAlign, at(100), then);
  return state;
}

TEST(StreamEffort, TheFirstEstimateSearchesAllAlignments) {
  EXPECT_EQ(due_effort({}, at(0), known(2), {}), Effort::kAlign);
}

TEST(StreamEffort, NothingIsDueWithoutNewRecordsOrWithinASecond) {
  const EffortState state = aligned(known(1000));
  EXPECT_EQ(due_effort(state, at(200), known(1000), {}), std::nullopt);
  EXPECT_EQ(due_effort(state, at(100.5), known(1010), {}), std::nullopt);
  EXPECT_EQ(due_effort(state, at(101), known(1010), {}), Effort::kExtend);
}

TEST(StreamEffort, ExtensionsKeepTheirShareOfTheTime) {
  const EffortState state = aligned(known(36000));
  EXPECT_EQ(due_effort(state, at(110), known(36010), {.work_share = 0.01}), std::nullopt);
  EXPECT_EQ(due_effort(state, at(110), known(36010), {.work_share = 0.1}), Effort::kExtend);
}

TEST(StreamEffort, ClosuresAreJudgedAgainWhenMoreIsKnown) {
  const EffortState state = aligned(known(1000, 100));
  EXPECT_EQ(due_effort(state, at(120), known(1100, 100), {}), Effort::kExtend);
  EXPECT_EQ(due_effort(state, at(120), known(1300, 100), {}), Effort::kJudge);
  EXPECT_EQ(due_effort(state, at(109), known(1300, 100), {}), Effort::kExtend);
  KnownCounts with_closure = known(1010, 100);
  with_closure.closures = 1;
  EXPECT_EQ(due_effort(state, at(120), with_closure, {}), Effort::kJudge);
}

TEST(StreamEffort, AlignmentsAreSearchedWhereFramesMayBeJoinedOrNothingIsCertain) {
  EffortState state = aligned(known(1000, 100));
  KnownCounts joinable = known(1010, 110);
  joinable.unjoined_links = 3;
  EXPECT_EQ(due_effort(state, at(130), joinable, {}), Effort::kExtend);
  joinable.unjoined_links = 4;
  EXPECT_EQ(due_effort(state, at(130), joinable, {}), Effort::kAlign);
  EXPECT_EQ(due_effort(state, at(110), joinable, {}), Effort::kExtend) << "too soon after the last search";
  state.weight = 0.9;
  EXPECT_EQ(due_effort(state, at(130), known(1010, 120), {}), Effort::kExtend);
  EXPECT_EQ(due_effort(state, at(130), known(1010, 151), {}), Effort::kAlign);
  state.weight = 1;
  state.is_contradicted = true;
  EXPECT_EQ(due_effort(state, at(130), known(1010, 110), {}), Effort::kAlign);
  state.note(Effort::kExtend, at(131), known(1010, 110));
  EXPECT_EQ(due_effort(state, at(133), known(1010, 111), {}), Effort::kJudge) << "before all are searched";
}

/// All judgements of a mission that grows evenly cost a few times as much as the last one.
TEST(StreamEffort, JudgementsGrowWithWhatIsKnown) {
  EffortState state;
  double judged = 0;
  int searches = 0;
  constexpr std::size_t kSeconds = 3600;
  for (std::size_t s = 1; s <= kSeconds; ++s) {
    KnownCounts now = known(10 * s, s);
    now.unjoined_links = s;  // none of the searches joins anything
    const auto effort = due_effort(state, at(static_cast<double>(s)), now, {});
    if (!effort) continue;
    state.note(*effort, at(static_cast<double>(s)), now);
    if (*effort != Effort::kExtend) judged += static_cast<double>(s);
    searches += *effort == Effort::kAlign;
  }
  EXPECT_LT(judged, 6 * kSeconds);
  EXPECT_LE(searches, 30);  // every judgement is one where links lie between frames
}

}  // namespace
}  // namespace radioslam
