#include "radioslam/study/wi_closure_kitti/wi_closure_kitti.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"
#include "study/small_town.hpp"

namespace radioslam {
namespace {

/// One robot's drive around two blocks, as if it had been recorded.
RecordedDrive short_drive() {
  CityParams town = small_town();
  town.robots = 1;
  town.path_length_m = 500;
  const auto [mission, truth] = simulate_city(town, 1);
  return {truth.robots[0].poses, mission.robots[0].odometry};
}

class WiClosureTable : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    KittiParams scenario = wi_closure_drive();
    scenario.cut = 0.5;
    scenario.dimension = 2;
    scenario.radio.links = 8;
    seed_ = reproduce_wi_closure_kitti(short_drive(), scenario, 3);
  }
  static WiClosureKitti seed_;
};
WiClosureKitti WiClosureTable::seed_;

TEST_F(WiClosureTable, BothModesSearchTheSamePairs) {
  EXPECT_GT(seed_.joint.search.candidates.pairs, 10000U);
  EXPECT_EQ(seed_.joint.search.candidates.pairs, seed_.link.search.candidates.pairs);
  EXPECT_EQ(seed_.joint.search.candidates.true_pairs, seed_.link.search.candidates.true_pairs);
  EXPECT_GT(*recall(seed_.joint.search.candidates), 0.9);
}

TEST_F(WiClosureTable, PruningKeepsTheAliasedMatchesOut) {
  ASSERT_TRUE(seed_.joint.aliased.ate_m && seed_.true_matches.ate_m && seed_.ate_oracle_m);
  EXPECT_LT(*seed_.joint.aliased.ate_m, 1.2 * *seed_.true_matches.ate_m + 0.05);
}

TEST_F(WiClosureTable, AliasedMatchesWreckWhatRadioDoesNotCheck) {
  ASSERT_TRUE(seed_.without_radio.ate_m && seed_.least_squares.ate_m);
  EXPECT_GT(*seed_.without_radio.ate_m, 5 * *seed_.joint.aliased.ate_m);
  EXPECT_GT(*seed_.least_squares.ate_m, 5 * *seed_.joint.aliased.ate_m);
}

TEST_F(WiClosureTable, HoldsThePublishedNumbersAndTheirContradictions) {
  const std::string text = table_text(wi_closure_kitti_table({seed_}));
  for (const char* part : {"1,099,101", "5,544", "7,049", "3,631", "1,913", "65.5 %", "99.69 %", "66.1",
                           "464 or 411", "1 % were missed", "Seed 3."})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(WiClosureTable, SeveralSeedsGiveTheirMedian) {
  WiClosureKitti other = seed_, third = seed_;
  other.ate_oracle_m = 77.25;
  third.ate_oracle_m = 99;
  const std::string text = table_text(wi_closure_kitti_table({other, seed_, third}));
  EXPECT_NE(text.find("77.25"), std::string::npos);
  EXPECT_NE(text.find("Medians of 3 seeds"), std::string::npos);
  EXPECT_EQ(wi_closure_kitti_json({other, seed_, third})["seeds"][2]["ate_oracle_m"], 99);
}

TEST_F(WiClosureTable, ThePageHoldsTheTable) {
  const std::string page = render_table_page(wi_closure_kitti_table({seed_}));
  for (const char* mark : {"@style@", "@script@", "@d3@", "@licence@", "@data@"})
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  EXPECT_NE(page.find("\"1,099,101\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
