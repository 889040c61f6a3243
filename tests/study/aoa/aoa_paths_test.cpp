#include "radioslam/study/aoa/aoa_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "radioslam/base/parallel.hpp"
#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

AoaParams quick() {
  AoaParams params;
  params.azimuths = 180;
  params.model_passes = 1;
  return params;
}

TEST(AoaPaths, EveryProfileMeasuresEverySeed) {
  const auto cells = measure_aoa_paths(2, 5, quick(), {});
  ASSERT_EQ(cells.size(), 6U);
  for (const AoaPathsCell& cell : cells) {
    ASSERT_EQ(cell.runs.size(), 2U);
    EXPECT_EQ(cell.runs[1].seed, 6U);
    for (const AoaPathsRun& run : cell.runs) EXPECT_TRUE(run.measured) << cell.profile;
  }
  EXPECT_EQ(aoa_paths_table(cells).rows.size(), 6U);
}

// Of 200 runs 96 % find all three paths and 94 % have the direct one within 2 degrees.
TEST(AoaPaths, SparseWavesResolveThreePaths) {
  const auto cells = measure_aoa_paths(8, 101, {}, {}, "sparse");
  ASSERT_EQ(cells.size(), 2U);
  for (const AoaPathsCell& cell : cells) {
    const auto all = std::count_if(cell.runs.begin(), cell.runs.end(),
                                   [](const AoaPathsRun& run) { return run.found == 3; });
    EXPECT_GE(all, 7) << word_for(cell.cards);
  }
}

TEST(AoaPaths, SameSeedsSameRunsOnAnyNumberOfThreads) {
  set_thread_count(1);
  const auto alone = aoa_paths_json(measure_aoa_paths(3, 1, quick(), {})).dump();
  set_thread_count(3);
  const auto together = aoa_paths_json(measure_aoa_paths(3, 1, quick(), {})).dump();
  set_thread_count(0);
  EXPECT_EQ(alone, together);
}

TEST(AoaPaths, TheTableCountsTheRuns) {
  const double degree_rad = 0.017453292519943295;
  const AoaPathsCell cell{"sparse",
                          AoaCards::kDrifting,
                          {{1, true, 3, 1 * degree_rad, 1 * degree_rad, 2},
                           {2, true, 3, 1.5 * degree_rad, 40 * degree_rad, 0},
                           {3, true, 2, 2.5 * degree_rad, 2.5 * degree_rad, 1},
                           {4, false, 0, 180 * degree_rad, 180 * degree_rad, 0}}};
  const StudyTable table = aoa_paths_table({cell});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0].label, "sparse, carrier offset and jitter");
  EXPECT_EQ(table.rows[0].cells,
            (std::vector<std::string>{"4", "50.0 %", "50.0 %", "25.0 %", "2.00", "0.75"}));
}

}  // namespace
}  // namespace radioslam
