#include "radioslam/study/team/team_study.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

TEST(TeamStudy, FaultsCostTimeAndBytesButNotTheFinalError) {
  constexpr double kPath_m = 120;
  const std::vector<TeamCase> cases{{3, kPath_m}, {3, kPath_m, .5}, {3, kPath_m, 0, 20}, {4, kPath_m}};
  const TeamStudy study = study_team(cases, 3, 1);
  ASSERT_EQ(study.samples.size(), cases.size());
  for (const auto& of_case : study.samples) {
    ASSERT_EQ(of_case.size(), 1U);
    const TeamSample& s = of_case.front();
    EXPECT_TRUE(s.all_know_all);
    ASSERT_TRUE(s.run_ate_m && s.agent_ate_m);
    EXPECT_NEAR(*s.agent_ate_m, *s.run_ate_m, 1e-6);
    EXPECT_GT(s.bytes, s.bytes_to_all);
  }
  const TeamSample &perfect = study.samples[0][0], &lossy = study.samples[1][0],
                   &divided = study.samples[2][0], &four = study.samples[3][0];
  EXPECT_EQ(perfect.lost, 0U);
  EXPECT_GT(lossy.bytes, perfect.bytes);
  EXPECT_NEAR(static_cast<double>(lossy.lost), .5 * static_cast<double>(lossy.messages),
              .1 * static_cast<double>(lossy.messages));
  EXPECT_LT(divided.way_share, perfect.way_share);
  EXPECT_GE(lossy.settled_s, perfect.settled_s);

  // The other ways know no faults; the same log goes to each of the others.
  for (const TeamSample* of : {&lossy, &divided}) {
    EXPECT_EQ(of->bytes_to_all, perfect.bytes_to_all);
    EXPECT_EQ(of->bytes_boxes_first, perfect.bytes_boxes_first);
  }
  EXPECT_GT(perfect.bytes_to_all, 2 * perfect.bytes_at_one);
  EXPECT_LT(perfect.bytes_to_all, 4 * perfect.bytes_at_one);
  EXPECT_GT(four.bytes_of_descriptors, perfect.bytes_of_descriptors);

  EXPECT_GT(study.descriptor_bytes, 100);
  EXPECT_LT(study.descriptor_bytes, 800);  // a bit and half a byte for each of 20 x 60 bins
  EXPECT_EQ(team_table(study).rows.size(), cases.size());
  EXPECT_EQ(text_of(cases[1]), "3 robots, 120 m each, loss 50 %");
  EXPECT_EQ(team_json(study)["cases"][2]["seeds"][0]["bytes"], divided.bytes);
}

}  // namespace
}  // namespace radioslam
