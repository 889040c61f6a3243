#include "radioslam/study/team/team_study.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"

namespace radioslam {
namespace {

TEST(TeamStudy, FaultsCostTimeAndBytesButNotTheFinalError) {
  const TeamCase of_three{3, 60}, of_two{2, 60}, faulty{3, 60, .4, 8};
  const TeamStudy study = study_team({of_three, faulty, of_two}, 3, 1);
  ASSERT_EQ(study.samples.size(), 3U);
  for (const auto& of_case : study.samples) {
    ASSERT_EQ(of_case.size(), 1U);
    const TeamSample& s = of_case.front();
    EXPECT_TRUE(s.all_know_all);
    ASSERT_TRUE(s.run_ate_m && s.agent_ate_m);
    EXPECT_NEAR(*s.agent_ate_m, *s.run_ate_m, 1e-6);
    EXPECT_GT(s.bytes, s.bytes_to_all);
  }
  const TeamSample &three = study.samples[0][0], &lossy = study.samples[1][0], &two = study.samples[2][0];
  EXPECT_EQ(three.lost, 0U);
  EXPECT_GT(static_cast<double>(lossy.lost), .3 * static_cast<double>(lossy.messages));
  EXPECT_GT(lossy.bytes, three.bytes);
  EXPECT_LT(lossy.way_share, three.way_share);
  EXPECT_GE(lossy.settled_s, three.settled_s);

  // The other ways know no faults; the same log goes to each of the others.
  EXPECT_EQ(lossy.bytes_to_all, three.bytes_to_all);
  EXPECT_EQ(lossy.bytes_boxes_first, three.bytes_boxes_first);
  EXPECT_GT(three.bytes_to_all, 2 * three.bytes_at_one);
  EXPECT_LT(three.bytes_to_all, 4 * three.bytes_at_one);
  EXPECT_GT(three.bytes_of_descriptors, two.bytes_of_descriptors);

  EXPECT_GT(study.descriptor_bytes, 100);
  EXPECT_LT(study.descriptor_bytes, 800);  // a bit and half a byte for each of 20 x 60 bins
  EXPECT_EQ(team_table(study).rows.size(), 3U);
  EXPECT_EQ(text_of(faulty), "3 x 60 m, loss 40 %, partition 8 s");
  EXPECT_EQ(team_json(study)["cases"][1]["seeds"][0]["bytes"], lossy.bytes);
  EXPECT_NE(render_team_page(study).find("\"team\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
