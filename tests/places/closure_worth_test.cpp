// The choice of closures against dense covariances and exhaustive search.
#include "radioslam/places/closure_worth.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "graph/random_graphs.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

using Chosen = std::vector<std::size_t>;

template <class Pose>
class ClosureWorth : public testing::Test {
 protected:
  static constexpr Eigen::Index kDof = Pose::kDof;

  explicit ClosureWorth(std::uint64_t seed = 3)
      : graph(test::draw_graph<Pose>(seed, 24, 1, test::Extras::kNone)),
        marginals(*Marginals<Pose>::compute(graph)) {
    for (const auto& [i, j] : {std::pair{2, 16}, {5, 20}, {6, 19}, {9, 14}, {11, 23}, {3, 8}})
      pairs.push_back({PoseId(static_cast<std::size_t>(i)), PoseId(static_cast<std::size_t>(j))});
  }

  PredictedPoses<Pose> predicted() const { return {graph.poses, marginals, kTemperature}; }
  Chosen choose(std::size_t count) const { return choose_by_worth(pairs, predicted(), cov_closure, count); }

  /// Covariance of the predicted poses of these pairs, from the dense one of all poses.
  Eigen::MatrixXd covariance(const Chosen& chosen) const {
    const auto n = static_cast<Eigen::Index>(graph.poses.size());
    Eigen::MatrixXd all(n * kDof, n * kDof);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) all.block<kDof, kDof>(i * kDof, j * kDof) = of_poses(i, j);
    Eigen::MatrixXd jacobian =
        Eigen::MatrixXd::Zero(kDof * static_cast<Eigen::Index>(chosen.size()), n * kDof);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const auto [i, j] = std::pair(pairs[chosen[k]].i.index(), pairs[chosen[k]].j.index());
      auto rows = jacobian.middleRows<kDof>(kDof * static_cast<Eigen::Index>(k));
      rows.template middleCols<kDof>(kDof * static_cast<Eigen::Index>(i)) =
          -(graph.poses[j].inverse() * graph.poses[i]).adjoint();
      rows.template middleCols<kDof>(kDof * static_cast<Eigen::Index>(j)).setIdentity();
    }
    return kTemperature * jacobian * all * jacobian.transpose();
  }

  /// 1/2 log det(I + C R^-1) of these pairs together.
  double information(const Chosen& chosen) const {
    Eigen::MatrixXd sum = covariance(chosen);
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(chosen.size()); ++k)
      sum.block<kDof, kDof>(k * kDof, k * kDof) += cov_closure;
    return (std::log(sum.determinant()) -
            static_cast<double>(chosen.size()) * std::log(cov_closure.determinant())) /
           2;
  }

  static constexpr double kTemperature = 1.5;
  PoseGraph<Pose> graph;
  Marginals<Pose> marginals;
  std::vector<WeighedPair> pairs;
  typename Pose::Jacobian cov_closure = Pose::Jacobian::Identity() * 0.01;

 private:
  Eigen::MatrixXd of_poses(Eigen::Index i, Eigen::Index j) const {
    const auto id = [](Eigen::Index k) { return variable(PoseId(static_cast<std::size_t>(k))); };
    if (i == j) return marginals.pose(PoseId(static_cast<std::size_t>(i)));
    return marginals.joint(id(i), id(j)).template topRightCorner<kDof, kDof>();
  }
};

using Poses = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(ClosureWorth, Poses);

TYPED_TEST(ClosureWorth, EveryChoiceAddsMostInformation) {
  Chosen so_far;
  for (const std::size_t next : this->choose(this->pairs.size())) {
    const auto with = [&](std::size_t k) {
      Chosen chosen = so_far;
      chosen.push_back(k);
      return this->information(chosen);
    };
    for (std::size_t k = 0; k < this->pairs.size(); ++k)
      if (std::find(so_far.begin(), so_far.end(), k) == so_far.end()) {
        EXPECT_GE(with(next), with(k) - 1e-9);
      }
    so_far.push_back(next);
  }
  EXPECT_EQ(so_far.size(), this->pairs.size());
}

TYPED_TEST(ClosureWorth, TwoPairsAreTheBestTwoOfAll) {
  const double chosen = this->information(this->choose(2));
  for (std::size_t k = 0; k < this->pairs.size(); ++k)
    for (std::size_t l = k + 1; l < this->pairs.size(); ++l)
      EXPECT_GE(chosen, this->information({k, l}) - 1e-9) << k << ' ' << l;
}

TYPED_TEST(ClosureWorth, ASecondTimeAPairAddsLittle) {
  this->pairs.push_back(this->pairs[this->choose(1).front()]);
  const Chosen chosen = this->choose(this->pairs.size());
  EXPECT_NE(chosen[1], this->pairs.size() - 1);
  EXPECT_LT(chosen.front(), this->pairs.size() - 1) << "of equal ones the first";
}

TYPED_TEST(ClosureWorth, UnderAnotherHypothesisAPairAddsAsMuch) {
  WeighedPair other = this->pairs[this->choose(1).front()];
  other.hypothesis = 1;
  other.weight = 0.99;
  this->pairs.push_back(other);
  EXPECT_EQ(this->choose(2)[1], this->pairs.size() - 1);
}

TYPED_TEST(ClosureWorth, WhatIsUnlikelyToHoldComesLast) {
  const std::size_t best = this->choose(1).front();
  this->pairs[best].probability = 1e-6;
  EXPECT_EQ(this->choose(this->pairs.size()).back(), best);
}

TYPED_TEST(ClosureWorth, NoMorePairsThanThereAre) {
  EXPECT_EQ(this->choose(100).size(), this->pairs.size());
  EXPECT_TRUE(this->choose(0).empty());
  this->pairs.clear();
  EXPECT_TRUE(this->choose(3).empty());
}

TEST(ProbabilityWithin, OfACircleAroundTheMean) {
  for (const double sigma_m : {0.1, 1.0, 3.0, 30.0})
    EXPECT_NEAR(probability_within(3, {0, 0}, sigma_m * sigma_m * Eigen::Matrix2d::Identity()),
                1 - std::exp(-4.5 / (sigma_m * sigma_m)), 1e-3);
}

TEST(ProbabilityWithin, IsTheShareOfDraws) {
  constexpr int kDraws = 200000;
  Eigen::Matrix2d root;
  root << 2, 0, 1.5, 0.4;
  const Eigen::Vector2d mean(1, -2);
  Rng rng(5);
  int within = 0;
  for (int k = 0; k < kDraws; ++k)
    within += (mean + root * Eigen::Vector2d(rng.normal(), rng.normal())).norm() < 2 ? 1 : 0;
  EXPECT_NEAR(probability_within(2, mean, root * root.transpose()), static_cast<double>(within) / kDraws,
              4e-3);
}

TEST(ProbabilityWithin, OfACertainPlaceIsZeroOrOne) {
  const Eigen::Matrix2d certain = Eigen::Matrix2d::Zero();
  EXPECT_NEAR(probability_within(2, {1, 1}, certain), 1, 1e-3);
  EXPECT_EQ(probability_within(2, {2, 2}, certain), 0);
}

}  // namespace
}  // namespace radioslam
