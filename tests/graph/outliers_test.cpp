#include "radioslam/graph/distributed/outliers.hpp"

#include "graph/small_teams.hpp"
#include "radioslam/graph/distributed/team_optimization.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr double kGate = 28;

// ---- the weight of a factor ----

/// Yang et al. 2020, equation (6), of the squared norm.
double surrogate(double s, double gate, double mu) {
  if (s <= mu / (mu + 1) * gate) return s;
  if (s >= (mu + 1) / mu * gate) return gate;
  return 2 * std::sqrt(gate * s * mu * (mu + 1)) - mu * (gate + s);
}

TEST(TruncatedWeight, IsTheSurrogatesDerivativeAndGivesItsValue) {
  for (const double mu : {0.01, 0.3, 1.0, 7.0, 100.0})
    for (double s = 0.05; s < 3 * kGate * (mu + 1) / mu; s *= 1.05) {
      const TruncatedWeight w = truncated_weight(s, kGate, mu);
      const double step = 1e-6 * s;
      const double slope = (surrogate(s + step, kGate, mu) - surrogate(s - step, kGate, mu)) / (2 * step);
      EXPECT_NEAR(w.weight, slope, 2e-4) << s << " " << mu;
      EXPECT_NEAR(w.weight * s + w.penalty, surrogate(s, kGate, mu), 1e-9 * (s + kGate)) << s << " " << mu;
    }
}

TEST(TruncatedWeight, FallsFromOneToZero) {
  for (const double mu : {0.01, 1.0, 100.0}) {
    double last = 1;
    EXPECT_EQ(truncated_weight(0, kGate, mu).weight, 1);
    for (double s = 0.05; s < 3 * kGate * (mu + 1) / mu; s *= 1.05) {
      const double weight = truncated_weight(s, kGate, mu).weight;
      EXPECT_GE(weight, 0);
      EXPECT_LE(weight, last);
      last = weight;
    }
    EXPECT_EQ(last, 0);
  }
}

TEST(TruncatedWeight, SharpensToTheGate) {
  EXPECT_EQ(truncated_weight(0.999 * kGate, kGate, 1e4).weight, 1);
  EXPECT_EQ(truncated_weight(1.001 * kGate, kGate, 1e4).weight, 0);
  EXPECT_EQ(truncated_weight(1.001 * kGate, kGate, 1e4).penalty, kGate);
}

TEST(TruncatedWeight, AtFirstLeavesOutWhatIsBeyondTheFirstCut) {
  const OutlierParams params{kGate};
  const double cut = params.first_cut * params.first_cut * kGate;
  EXPECT_GT(truncated_weight(0.99 * cut, kGate, params.first_mu()).weight, 0);
  EXPECT_EQ(truncated_weight(1.01 * cut, kGate, params.first_mu()).weight, 0);
}

// ---- teams ----

template <class Pose>
struct SpoiledTeam {
  test::SmallTeam<Pose> team;
  std::vector<bool> wrong;  ///< per relative pose
};

/// A ring of robots, with loops within each, too; three of ten loops between robots, drawn pair by pair, and
/// one of each robot's own are wrong.
template <class Pose>
SpoiledTeam<Pose> draw_spoiled(std::uint64_t seed) {
  constexpr std::size_t kRobots = 3, kSteps = 20;
  test::Drawing<Pose> draw(seed);
  SpoiledTeam<Pose> spoiled;
  spoiled.team = test::draw_team<Pose>(seed, kRobots, kSteps, 1, test::ring_of(kRobots), 2);
  auto& factors = spoiled.team.graph.relative_poses;
  const auto robot = [&](PoseId p) { return p.index() / kSteps; };
  // Odometry's values are as good as measurements over a few steps.
  for (std::size_t r = 0; r < kRobots; ++r)
    for (std::size_t k = 0; k + 3 < kSteps; k += 5) {
      auto f = factors.front();
      f.i = PoseId(r * kSteps + k);
      f.j = PoseId(r * kSteps + k + 3);
      f.T_i_j = spoiled.team.graph.poses[f.i.index()].inverse() * spoiled.team.graph.poses[f.j.index()] *
                draw.pose(0.05, 0.02);
      factors.push_back(f);
    }
  spoiled.wrong.assign(factors.size(), false);
  const auto spoil = [&](std::vector<std::size_t> loops, std::size_t count) {
    for (; count > 0; --count) {
      const std::size_t k = draw.rng.below(loops.size());
      factors[loops[k]].T_i_j = factors[loops[k]].T_i_j * draw.pose(8, 1.5);
      spoiled.wrong[loops[k]] = true;
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(k));
    }
  };
  for (std::size_t a = 0; a < kRobots; ++a)
    for (std::size_t b = a; b < kRobots; ++b) {
      std::vector<std::size_t> loops;
      for (std::size_t k = 0; k < factors.size(); ++k)
        if (robot(factors[k].i) == a && robot(factors[k].j) == b &&
            factors[k].j.index() != factors[k].i.index() + 1)
          loops.push_back(k);
      spoil(loops, a == b ? 1 : loops.size() * 3 / 10);
    }
  return spoiled;
}

template <class Pose>
class Outliers : public testing::Test {};
TYPED_TEST_SUITE(Outliers, test::PoseTypes);

TYPED_TEST(Outliers, AreRejectedAndAllOthersKept) {
  for (const auto method : {DistributedMethod::kSeparators, DistributedMethod::kAsynchronous})
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const auto spoiled = draw_spoiled<TypeParam>(seed);
      TeamOptimizationParams params;
      params.method = method;
      params.outliers.gate = kGate;
      if (method == DistributedMethod::kAsynchronous) params.network = {0.2, 3, 0.1, 1};
      const auto result = optimize_team(spoiled.team.graph, spoiled.team.poses, params);
      EXPECT_TRUE(result.settled);
      ASSERT_EQ(result.weights.size(), spoiled.wrong.size());
      auto kept = spoiled.team.graph;
      kept.relative_poses.clear();
      for (std::size_t k = 0; k < spoiled.wrong.size(); ++k) {
        EXPECT_EQ(result.weights[k] < 0.5, spoiled.wrong[k]) << seed << ": " << k;
        if (!spoiled.wrong[k]) kept.relative_poses.push_back(spoiled.team.graph.relative_poses[k]);
      }
      const double central = test::central_optimum(kept);
      kept.poses = result.poses;
      double cost = 0;
      for (const auto& f : kept.relative_poses) cost += squared_norm(kept, f);
      EXPECT_NEAR(cost, central, 1e-3 * central);
    }
}

TYPED_TEST(Outliers, CandidatesAreAllButOdometry) {
  const auto spoiled = draw_spoiled<TypeParam>(4);
  for (const auto& robot : split_by_robot(spoiled.team.graph, spoiled.team.poses)) {
    const auto candidates = outlier_candidates(robot);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const auto& f = robot.graph.relative_poses[k];
      const bool odometry = k < robot.own_relative_poses && f.j.index() == f.i.index() + 1;
      EXPECT_EQ(candidates[k], !odometry);
    }
  }
}

}  // namespace
}  // namespace radioslam
