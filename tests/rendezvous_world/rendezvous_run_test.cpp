#include "radioslam/rendezvous_world/rendezvous_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

/// Figures over several seeds.
struct Mean {
  double squared_error = 0, nees = 0, metres = 0, below = 0, crossings = 0;
};

Mean mean_over(const RendezvousRunParams& params, int seeds, bool leave_outliers_out = false) {
  Mean mean;
  for (int k = 0; k < seeds; ++k) {
    RendezvousRunOptions options;
    options.seed = 501 + static_cast<std::uint64_t>(k);
    options.leave_outliers_out = leave_outliers_out;
    const RendezvousRun run = run_rendezvous(params, options);
    mean.squared_error += run.ate_trans_mean_squared / seeds;
    mean.nees += run.nees / seeds;
    mean.metres += run.metres_walked / seeds;
    const auto below = std::count_if(run.crossings.begin(), run.crossings.end(),
                                     [&](const auto& each) { return each.after <= run.delta; });
    mean.crossings += static_cast<double>(run.crossings.size()) / seeds;
    mean.below += run.crossings.empty()
                      ? 1.0 / seeds
                      : static_cast<double>(below) / static_cast<double>(run.crossings.size()) / seeds;
  }
  return mean;
}

RendezvousRunParams two_robots(const std::string& policy) {
  RendezvousRunParams params;
  params.side_m = 54.77;
  params.metres_each = 100;
  params.robot.policy = policy;
  return params;
}

TEST(RendezvousRun, AtEqualMetresCallsBeatChanceAndLandmarksBeatCalls) {
  constexpr int kSeeds = 30;
  const Mean random = mean_over(two_robots("random"), kSeeds),
             active = mean_over(two_robots("active"), kSeeds),
             anchored = mean_over(two_robots("anchored"), kSeeds);
  for (const Mean& mean : {random, active, anchored}) {
    EXPECT_NEAR(mean.metres, 200, 0.01);
    EXPECT_GT(mean.nees, 0.5);
    EXPECT_LT(mean.nees, 2);
  }
  EXPECT_LT(active.squared_error, 0.45 * random.squared_error);
  EXPECT_LT(anchored.squared_error, 0.7 * active.squared_error);
}

TEST(RendezvousRun, ErrorsAreBackBelowTheThresholdAfterAnOptimization) {
  RendezvousRunParams params;
  params.robots = 30;
  for (const char* monitor : {"uncertainty", "seed"}) {
    params.robot.monitor = monitor;
    const Mean mean = mean_over(params, 3);
    EXPECT_GT(mean.crossings, 10) << monitor;
    EXPECT_GT(mean.below, 0.95) << monitor;
    EXPECT_GT(mean.nees, 0.5) << monitor;
    EXPECT_LT(mean.nees, 2) << monitor;
  }
}

TEST(RendezvousRun, AnglesFindGrossOutliersAndDoNoHarmWithoutThem) {
  constexpr int kSeeds = 30;
  RendezvousRunParams params;
  params.robots = 5;
  params.side_m = 20;
  params.robot.policy = "random";  // weights change the estimate alone
  const auto error = [&](const char* weights, bool outliers, bool leave_out = false) {
    params.robot.estimate.angle_weights = weights;
    params.outliers = outliers;
    return mean_over(params, kSeeds, leave_out).squared_error;
  };
  EXPECT_NEAR(error("posterior", false) / error("off", false), 1, 0.02);
  params.outlier_kind = "sigma";
  EXPECT_NEAR(error("posterior", true) / error("off", true), 1, 0.02);
  params.outlier_kind = "gross";
  const double off = error("off", true), label = error("off", true, true);
  EXPECT_GT(off - error("posterior", true), 0.6 * (off - label));
}

TEST(RendezvousRun, RobotsWithoutStartsAreMeasuredInTheFrameTheyAreIn) {
  RendezvousRunParams params = two_robots("active");
  params.side_m = 30;
  params.starts_known = false;
  const Mean mean = mean_over(params, 8);
  EXPECT_GT(mean.nees, 0.4);
  EXPECT_LT(mean.nees, 2);
  EXPECT_LT(mean.squared_error, 60);
}

TEST(RendezvousRun, HasTheSameResultsForAnyNumberOfThreads) {
  RendezvousRunParams params;
  params.robots = 12;
  params.obstacles = 4;
  params.iterations = 30;
  params.loss_share = 0.3;
  const auto with_threads = [&](std::size_t threads) {
    set_thread_count(threads);
    const RendezvousRun run = run_rendezvous(params, {});
    set_thread_count(0);
    return std::pair(run.error, run.ate_trans_mean_squared);
  };
  EXPECT_EQ(with_threads(1), with_threads(3));
}

TEST(RendezvousRun, GoesOnWhenAThirdOfThePacketsIsLost) {
  RendezvousRunParams params = two_robots("active");
  params.robots = 4;
  params.obstacles = 5;
  params.loss_share = 0.33;
  RendezvousRunParams by_chance = params;
  by_chance.robot.policy = "random";
  EXPECT_LT(mean_over(params, 8).squared_error, 0.6 * mean_over(by_chance, 8).squared_error);
}

}  // namespace
}  // namespace radioslam
