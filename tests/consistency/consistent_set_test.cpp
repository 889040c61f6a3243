#include "radioslam/consistency/consistent_set.hpp"

#include <gtest/gtest.h>

#include "consistency/walks.hpp"
#include "radioslam/consistency/consistency_params.hpp"

namespace radioslam {
namespace {

template <class Pose>
class ConsistentSets : public testing::Test {
 protected:
  Rng rng{9};
  test::TwoWalks<Pose> walks{rng, 60, 0.05, 0.01};
  OdometryChain<Pose> a = walks.odometry_a(rng), b = walks.odometry_b(rng);

  std::size_t any() { return static_cast<std::size_t>(rng.below(60)); }
  RelativePoseMatch<Pose> right() { return walks.true_match(rng, any(), any(), 0.2, 0.03); }
  RelativePoseMatch<Pose> wrong() {
    auto match = right();
    match.T_a_b = Pose::exp(5 * test::normal_tangent<Pose>(rng));
    return match;
  }
};
using Poses = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(ConsistentSets, Poses);

TYPED_TEST(ConsistentSets, KeepsTheTrueAndReportsWhyNotTheOthers) {
  std::vector<RelativePoseMatch<TypeParam>> matches;
  for (int k = 0; k < 10; ++k) {
    for (int n = 0; n < 4; ++n) matches.push_back(this->wrong());
    matches.push_back(this->right());
  }
  ConsistentSetParams params;
  params.pairwise.confidence = 0.9999;  // of 45 true pairs none shall fail by chance
  const auto set = largest_consistent_set(this->a, this->b, matches, params);
  EXPECT_EQ(set.members, (std::vector<std::size_t>{4, 9, 14, 19, 24, 29, 34, 39, 44, 49}));
  EXPECT_TRUE(set.proven);
  EXPECT_LE(set.second_largest, 4U);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    EXPECT_EQ(set.matches[k].is_in, k % 5 == 4);
    if (set.matches[k].is_in) {
      EXPECT_EQ(set.matches[k].consistent, 9U);
    }
    EXPECT_EQ(*set.matches[k].best_statistic <= set.gate, set.matches[k].consistent > 0);
  }
}

/// False matches that agree with each other form a clique of their own: the larger one wins.
TYPED_TEST(ConsistentSets, RunnerUpCountsFalseMatchesThatAgree) {
  using Pose = TypeParam;
  std::vector<RelativePoseMatch<Pose>> matches;
  const Pose aliased = Pose::exp(5 * test::normal_tangent<Pose>(this->rng));
  for (int k = 0; k < 12; ++k) matches.push_back(this->right());
  for (int k = 0; k < 7; ++k) {
    auto match = this->right();  // as if b had taken another path
    match.T_a_b = test::disturbed<Pose>(
        this->rng, this->walks.a[match.pose_a].inverse() * aliased * this->walks.b[match.pose_b],
        match.covariance);
    matches.push_back(match);
  }
  ConsistentSetParams params;
  params.pairwise.confidence = 0.9999;
  const auto set = largest_consistent_set(this->a, this->b, matches, params);
  EXPECT_EQ(set.members.size(), 12U);
  EXPECT_EQ(set.members.back(), 11U);
  EXPECT_EQ(set.second_largest, 7U);
}

TEST(ConsistencyParams, GateByCovariancesUnlessTheyAreTheIdentity) {
  ConsistencyParams params;
  EXPECT_FALSE(pairwise_params(params).max_norm);
  EXPECT_EQ(pairwise_params(params).confidence, PairwiseParams{}.confidence);
  EXPECT_TRUE(are_enough(1, params));
  params.covariance = "identity";
  EXPECT_EQ(pairwise_params(params).max_norm, 100);
  EXPECT_FALSE(are_enough(4, params));
  EXPECT_TRUE(are_enough(5, params));
}

TYPED_TEST(ConsistentSets, OfOneMatchOrNone) {
  const auto none = largest_consistent_set<TypeParam>(this->a, this->b, {});
  EXPECT_TRUE(none.members.empty() && none.matches.empty());
  const auto one = largest_consistent_set<TypeParam>(this->a, this->b, {this->wrong()});
  EXPECT_EQ(one.members.size(), 1U);
  EXPECT_TRUE(one.matches[0].is_in);
  EXPECT_FALSE(one.matches[0].best_statistic.has_value());
}

}  // namespace
}  // namespace radioslam
