#include "radioslam/study/overlap_growth/overlap_growth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"

namespace radioslam {
namespace {

OverlapGrowthPoint point(std::size_t poses, double kept, double search_s) {
  OverlapGrowthPoint p;
  p.poses = poses;
  p.kept = kept;
  p.search_s = search_s;
  return p;
}

TEST(GrowthExponent, IsThePowerOfThePosesAndPairsKept) {
  std::vector<OverlapGrowthPoint> points{point(1000, 1e3, 7)};  // too small to count
  for (const std::size_t poses : {10000U, 30000U, 100000U}) {
    const double kept = 0.7 * static_cast<double>(poses), items = 2 * static_cast<double>(poses) + kept;
    points.push_back(point(poses, kept, 1e-6 * std::pow(items, 1.2)));
  }
  EXPECT_NEAR(*growth_exponent(points), 1.2, 1e-12);
  points.resize(2);
  EXPECT_FALSE(growth_exponent(points));
}

TEST(OverlapGrowth, IsMeasuredTownByTownInBothModes) {
  const OverlapGrowth growth = measure_overlap_growth(1500, 2);
  ASSERT_EQ(growth.joint.size(), 1U);
  ASSERT_EQ(growth.link.size(), 1U);
  EXPECT_EQ(growth.joint[0].poses, 1000U);
  for (const auto* points : {&growth.joint, &growth.link})
    for (const OverlapGrowthPoint& p : *points) {
      EXPECT_EQ(p.pairs, static_cast<double>(p.poses * p.poses));
      EXPECT_GT(p.kept, 0);
      EXPECT_LT(p.kept, 0.1 * p.pairs);
      EXPECT_LE(p.distances_evaluated, 3 * p.kept + 2 * static_cast<double>(p.poses));
      EXPECT_TRUE(p.all_pairs_s.has_value());
    }
  const auto json = overlap_growth_json(growth);
  EXPECT_EQ(json["joint"]["towns"].size(), 1U);
  EXPECT_TRUE(json["joint"]["exponent"].is_null());
  EXPECT_EQ(overlap_growth_table(growth).rows.size(), 2U);
  EXPECT_NE(render_growth_page(growth).find("\"growth\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
