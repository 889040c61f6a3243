#include "radioslam/consistency/pairwise.hpp"

#include <gtest/gtest.h>

#include "consistency/walks.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/consistency/chi_squared.hpp"

namespace radioslam {
namespace {

template <class Pose>
class Pairwise : public testing::Test {
 protected:
  Rng rng{5};
  Pose pose() { return Pose::exp(2 * test::normal_tangent<Pose>(rng)); }
};
using Poses = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(Pairwise, Poses);

TYPED_TEST(Pairwise, JacobiansEqualNumericalOnes) {
  using Pose = TypeParam;
  using Tangent = typename Pose::Tangent;
  constexpr double h = 1e-6;
  const auto derivative = [&](auto&& loop) {
    typename Pose::Jacobian j;
    for (int k = 0; k < Pose::kDof; ++k) {
      const Tangent step = h * Tangent::Unit(k);
      j.col(k) = (loop(Pose::exp(step)).log() - loop(Pose::exp(-step)).log()) / (2 * h);
    }
    return j;
  };
  for (int trial = 0; trial < 20; ++trial) {
    const Pose f = this->pose(), z_j = this->pose(), e = this->pose();
    const Pose z_i = e * z_j * f.inverse();  // the loop closes
    const auto by = loop_jacobians(f, z_j, e);
    const auto loop = [](const Pose& zi, const Pose& ff, const Pose& zj, const Pose& ee) {
      return zi * ff * zj.inverse() * ee.inverse();
    };
    const double tolerance = 1e-6 * (1 + by.z_i.norm());
    EXPECT_LT((by.z_i - derivative([&](const Pose& d) { return loop(z_i * d, f, z_j, e); })).norm(),
              tolerance);
    EXPECT_LT((by.f - derivative([&](const Pose& d) { return loop(z_i, f * d, z_j, e); })).norm(), tolerance);
    EXPECT_LT((by.z_j - derivative([&](const Pose& d) { return loop(z_i, f, z_j * d, e); })).norm(),
              tolerance);
    EXPECT_LT((by.e - derivative([&](const Pose& d) { return loop(z_i, f, z_j, e * d); })).norm(), tolerance);
  }
}

TYPED_TEST(Pairwise, IncrementsHaveTheCovarianceOfTheirSteps) {
  using Pose = TypeParam;
  using Jacobian = typename Pose::Jacobian;
  const test::TwoWalks<Pose> walks(this->rng, 40, 0.1, 0.02);
  const OdometryChain<Pose> chain(walks.a, walks.covariances_a);
  // Step by step: X_k+1 = X_k D_k gives Sigma <- Ad(D_k^-1) Sigma Ad(D_k^-1)^T + Q_k.
  Jacobian sigma = Jacobian::Zero();
  for (std::size_t k = 7; k < 33; ++k) {
    const Jacobian ad = (walks.a[k].inverse() * walks.a[k + 1]).inverse().adjoint();
    sigma = ad * sigma * ad.transpose() + walks.covariances_a[k];
  }
  EXPECT_LT((chain.increment_covariance(7, 33) - sigma).norm(), 1e-10 * sigma.norm());
  const Pose t = walks.a[7].inverse() * walks.a[33];
  EXPECT_LT((t.inverse() * chain.increment(7, 33)).log().norm(), 1e-10);
  // And of the inverse, Ad(T) Sigma Ad(T)^T.
  const Jacobian back = t.adjoint() * sigma * t.adjoint().transpose();
  EXPECT_LT((chain.increment_covariance(33, 7) - back).norm(), 1e-10 * back.norm());
  EXPECT_EQ(chain.increment_covariance(7, 7), Jacobian::Zero());
}

/// Mean and fraction above the 99 % gate over many draws of odometry and of two matches `poses_apart` poses
/// apart.
template <class Pose>
void expect_chi_squared(Rng& rng, int draws, std::size_t poses_apart, double sigma_m, double sigma_rad) {
  const test::TwoWalks<Pose> walks(rng, poses_apart + 1, sigma_m, sigma_rad);
  const double gate = chi_squared_quantile(0.99, Pose::kDof);
  double sum = 0;
  int above = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const auto a = walks.odometry_a(rng), b = walks.odometry_b(rng);
    const auto i = walks.true_match(rng, 0, poses_apart, 0.2, 0.03),
               j = walks.true_match(rng, poses_apart, 0, 0.2, 0.03);
    const double statistic = pair_statistic(a, b, i, j);
    sum += statistic;
    if (statistic > gate) ++above;
  }
  const double sigma_of_mean = std::sqrt(2.0 * Pose::kDof / draws);
  EXPECT_NEAR(sum / draws, Pose::kDof, 5 * sigma_of_mean + 0.02 * Pose::kDof) << poses_apart;
  EXPECT_NEAR(static_cast<double>(above) / draws, 0.01, 5 * std::sqrt(0.01 * 0.99 / draws)) << poses_apart;
}

TYPED_TEST(Pairwise, StatisticOfTruePairsIsChiSquared) {
  expect_chi_squared<TypeParam>(this->rng, 4000, 1, 0.05, 0.01);
  expect_chi_squared<TypeParam>(this->rng, 4000, 10, 0.05, 0.005);
}

TYPED_TEST(Pairwise, StatisticStaysChiSquaredOverLongPaths) {
  expect_chi_squared<TypeParam>(this->rng, 1500, 150, 0.02, 0.002);
}

/// To first order: the smaller the noise, the less.
TYPED_TEST(Pairwise, OrderAndViewpointDoNotMatter) {
  using Pose = TypeParam;
  const test::TwoWalks<Pose> walks(this->rng, 30, 1e-5, 2e-6);
  const auto a = walks.odometry_a(this->rng), b = walks.odometry_b(this->rng);
  for (int trial = 0; trial < 50; ++trial) {
    const auto i = walks.true_match(this->rng, this->rng.below(30), this->rng.below(30), 2e-5, 3e-6);
    const auto j = walks.true_match(this->rng, this->rng.below(30), this->rng.below(30), 2e-5, 3e-6);
    const double statistic = pair_statistic(a, b, i, j);
    EXPECT_NEAR(pair_statistic(a, b, j, i), statistic, 1e-3 * (1 + statistic));
    // The same measurements as seen from the other robot.
    const auto turned = [](const RelativePoseMatch<Pose>& m) {
      const auto ad = m.T_a_b.adjoint();
      return RelativePoseMatch<Pose>{m.pose_b, m.pose_a, m.T_a_b.inverse(),
                                     ad * m.covariance * ad.transpose()};
    };
    EXPECT_NEAR(pair_statistic(b, a, turned(i), turned(j)), statistic, 1e-3 * (1 + statistic));
  }
}

TYPED_TEST(Pairwise, GraphHoldsTheResultOfEveryPairForAnyNumberOfThreads) {
  using Pose = TypeParam;
  const test::TwoWalks<Pose> walks(this->rng, 30, 0.1, 0.02);
  const auto a = walks.odometry_a(this->rng), b = walks.odometry_b(this->rng);
  std::vector<RelativePoseMatch<Pose>> matches;
  for (int k = 0; k < 40; ++k) {
    matches.push_back(walks.true_match(this->rng, this->rng.below(30), this->rng.below(30), 0.2, 0.03));
    if (k % 2 == 1) matches.back().T_a_b = this->pose();
  }
  set_thread_count(1);
  const auto one = pairwise_consistency(a, b, matches);
  set_thread_count(3);
  const auto three = pairwise_consistency(a, b, matches);
  set_thread_count(0);
  EXPECT_EQ(one.statistics, three.statistics);
  EXPECT_NEAR(one.gate, Pose::kDof == 3 ? 11.345 : 16.812, 1e-3);
  EXPECT_GT(one.graph.edges(), 100U);
  for (std::size_t i = 0; i < matches.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double statistic = pair_statistic(a, b, matches[i], matches[j]);
      EXPECT_EQ(one.statistic(j, i), static_cast<double>(static_cast<float>(statistic)));
      EXPECT_EQ(one.graph.connected(i, j), statistic <= one.gate);
    }
}

/// Two matches of robots that stand still, the second off by `error`.
template <class Pose>
PairwiseConsistency off_by(const typename Pose::Tangent& error, const PairwiseParams& params) {
  const OdometryChain<Pose> chain({Pose()}, {});
  return pairwise_consistency<Pose>(chain, chain, {{0, 0, Pose()}, {0, 0, Pose::exp(error)}}, params);
}

TYPED_TEST(Pairwise, WithUnitWeightsAMetreAndARadianCountAlike) {
  using Tangent = typename TypeParam::Tangent;
  const Tangent metre = Tangent::Unit(0), radian = Tangent::Unit(TypeParam::kDof - 1);
  PairwiseParams params;
  params.max_norm = 1.2;
  for (const Tangent& error : {metre, radian, Tangent(0.8 * metre - 0.6 * radian)}) {
    const auto pairs = off_by<TypeParam>(error, params);
    EXPECT_NEAR(pairs.statistic(0, 1), 1, 1e-6);
    EXPECT_DOUBLE_EQ(pairs.gate, 1.44);
    EXPECT_TRUE(pairs.graph.connected(0, 1));
  }
  EXPECT_NEAR(off_by<TypeParam>(metre + radian, params).statistic(0, 1), 2, 1e-6);
  EXPECT_FALSE(off_by<TypeParam>(metre + radian, params).graph.connected(0, 1));
}

TYPED_TEST(Pairwise, WithUnitWeightsTheOdometryIsFollowedAndNoCovarianceMatters) {
  using Pose = TypeParam;
  const test::TwoWalks<Pose> walks(this->rng, 30, 0.1, 0.02);
  const auto a = walks.odometry_a(this->rng), b = walks.odometry_b(this->rng);
  auto i = walks.true_match(this->rng, 3, 25, 0.2, 0.03), j = walks.true_match(this->rng, 20, 1, 0.2, 0.03);
  const typename Pose::Tangent error =
      (i.T_a_b * b.increment(25, 1) * j.T_a_b.inverse() * a.increment(3, 20).inverse()).log();
  i.covariance.setZero(), j.covariance *= 100;
  PairwiseParams params;
  params.max_norm = 1;
  const auto pairs = pairwise_consistency<Pose>(a, b, {j, i}, params);
  EXPECT_NEAR(pairs.statistic(0, 1), error.squaredNorm(), 1e-5 * error.squaredNorm());
}

TEST(PairwiseDeathTest, RefusesPosesThatAreNotThere) {
  const OdometryChain<SE2> chain({SE2(), SE2()}, {SE2::Jacobian::Identity()});
  EXPECT_DEATH(pairwise_consistency<SE2>(chain, chain, {{0, 2, SE2()}}), "poses of the chains");
  EXPECT_DEATH(OdometryChain<SE2>({SE2(), SE2()}, {}), "one step less");
}

TEST(LoopStatistic, CovarianceThatIsNoneGivesAnInfiniteStatistic) {
  EXPECT_EQ(loop_statistic<SE2>({SE2()}, {SE2()}, {SE2()}, {SE2()}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace radioslam
