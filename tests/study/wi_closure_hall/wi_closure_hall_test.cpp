#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"
#include "radioslam/study/wi_closure_hall/hall_tables.hpp"
#include "study/wi_closure/stages.hpp"

namespace radioslam {
namespace {

/// A short drive with coarse scans.
HallParams small_hall() {
  HallParams hall = scanned_hall();
  hall.path_length_m = 8;
  hall.speed_mps = 1;
  hall.onboard.lidar.lidar_beams = 8;
  hall.onboard.lidar.lidar_azimuth_steps = 120;
  hall.onboard.lidar.lidar_rotation_hz = 3;
  return hall;
}

class WiClosureHallTable : public testing::Test {
 protected:
  static void SetUpTestSuite() { hall_ = reproduce_wi_closure_hall(small_hall(), 3, kThesisRadius_m); }
  static WiClosureHall hall_;
};
WiClosureHall WiClosureHallTable::hall_;

TEST_F(WiClosureHallTable, EveryStageKeepsAPartOfTheOneBefore) {
  ASSERT_EQ(hall_.places.runs.size(), 3U);
  expect_stages_in_order(hall_.places);
}

TEST_F(WiClosureHallTable, CountsPairsByBothCriteria) {
  ASSERT_TRUE(hall_.places.within_radius);
  const PairCounts &by_view = hall_.places.search.candidates, &near = hall_.places.within_radius->candidates;
  EXPECT_EQ(near.pairs, by_view.pairs);
  EXPECT_LT(near.true_pairs, by_view.true_pairs);
  EXPECT_LT(near.kept, by_view.kept);
  EXPECT_NE(table_text(wi_closure_hall_table({hall_})).find("within 3.6 m: false pairs rejected"),
            std::string::npos);
}

TEST_F(WiClosureHallTable, InOneRoundNoPairCountsTwice) {
  for (const std::size_t k : {1U, 2U}) expect_no_pair_twice(hall_.places.runs[k]);
}

TEST_F(WiClosureHallTable, HoldsThePublishedNumbersAndTheirContradictions) {
  const std::string text = table_text(wi_closure_hall_table({hall_}));
  for (const char* part : {"1,848", "119", "115", "78.7 %", "93.6 %", "17.6", "1.9", "155", "36", "0.5",
                           "defaults: registrations", "DiSCo-SLAM: ATE, m", "loosened: verified",
                           "adds metres to radians", "Seed 3."})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(WiClosureHallTable, SeveralSeedsGiveTheirMedian) {
  WiClosureHall other = hall_, third = hall_;
  for (WiClosureHall* hall : {&other, &third}) hall->places.runs[1].pruned.in_one_frame = true;
  other.places.runs[1].pruned.ate_m = 77.25;
  third.places.runs[1].pruned.ate_m = 99;
  const std::string text = table_text(wi_closure_hall_table({other, hall_, third}));
  EXPECT_NE(text.find("77.25"), std::string::npos);
  EXPECT_NE(text.find("Medians of 3 seeds"), std::string::npos);
  EXPECT_NE(text.find("3 of 3"), std::string::npos);
  const auto json = wi_closure_hall_json({other, hall_, third});
  EXPECT_EQ(json["seeds"][2]["disco"]["pruned"]["ate_m"], 99);
  EXPECT_EQ(json["published"]["kept"], 119);
}

TEST_F(WiClosureHallTable, AnglesHaveARowEachAndTheirSums) {
  WiClosureHall hall = hall_;
  ASSERT_FALSE(hall.places.angles.empty());
  for (const AnglePaths& angle : hall.places.angles) EXPECT_EQ(angle.weights.size(), angle.paths);
  hall.places.angles = {{5, 2, {0.1, 0.1, 0.8, 0, 0}, true},
                        {4, kNoDirectPath, {0.1, 0.1, 0.1, 0.1}, false},
                        {6, 0, {0.1, 0.9, 0, 0, 0, 0}, true}};
  const AngleCounts counts = count_angles({hall, hall});
  EXPECT_EQ(counts.angles, 6U);
  EXPECT_EQ(counts.with_direct, 4U);
  EXPECT_EQ(counts.direct_found, 2U);
  EXPECT_EQ(counts.paths, 30U);
  const StudyTable table = hall_angles_table({hall, hall});
  EXPECT_EQ(table.rows.size(), 6U);
  EXPECT_EQ(table.rows[0].cells, (std::vector<std::string>{"5", "3", "3", "0.80", "direct"}));
  EXPECT_EQ(table.rows[1].cells, (std::vector<std::string>{"4", "none", "1", "0.10", "rejected rightly"}));
  EXPECT_EQ(table.rows[2].cells, (std::vector<std::string>{"6", "1", "2", "0.90", "another path"}));
  EXPECT_NE(table.lead.find("2 direct of 4 measurements with one, 30 paths"), std::string::npos);
  EXPECT_NE(table.lead.find("3 direct of 17"), std::string::npos);
}

TEST_F(WiClosureHallTable, ThePageHoldsBothTables) {
  const std::string page = render_table_page(wi_closure_hall_table({hall_}), {hall_angles_table({hall_})});
  EXPECT_NE(page.find("\"1,848\""), std::string::npos);
  EXPECT_NE(page.find("\"Paths of the angles\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
