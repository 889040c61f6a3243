// The alignment grid finds known relative poses, and its error propagation agrees with Monte Carlo sampling.
#include "radioslam/team_frame/alignment_grid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;

/// True relative pose of the free reference end.
struct TruePlace {
  double distance_m, phi_rad, theta_rad;
  SE2 T_placed_free() const {
    return {distance_m * Eigen::Vector2d(std::cos(phi_rad), std::sin(phi_rad)), theta_rad};
  }
};

SE2 pose_of(const GridEnd& end) { return {end.position, end.heading_rad}; }

GridEnd random_end(Rng& rng) {
  GridEnd end;
  end.position = {rng.uniform(-80, 80), rng.uniform(-80, 80)};
  end.heading_rad = rng.uniform(-kHalfTurn_rad, kHalfTurn_rad);
  end.covariance = Eigen::Vector3d(0.1, 0.1, 1e-4).asDiagonal();
  return end;
}

/// Azimuth of b's position seen from a.
double azimuth(const SE2& a, const SE2& b) {
  const Eigen::Vector2d seen = a.inverse() * b.translation();
  return std::atan2(seen.y(), seen.x());
}

GridBearing bearing(const GridEnd& placed, const GridEnd& free, bool received_by_placed,
                    const TruePlace& truth, Rng& rng) {
  const SE2 a = pose_of(placed), b = truth.T_placed_free() * pose_of(free);
  const double sigma = 0.15;
  GridBearing link{placed, free, received_by_placed, {}, {sigma, sigma, sigma}, {0.4, 0.3, 0.3}};
  link.azimuth_rad = {rng.uniform(-kHalfTurn_rad, kHalfTurn_rad), rng.uniform(-kHalfTurn_rad, kHalfTurn_rad),
                      rng.uniform(-kHalfTurn_rad, kHalfTurn_rad)};
  link.azimuth_rad[rng.below(3)] =
      (received_by_placed ? azimuth(a, b) : azimuth(b, a)) + rng.normal(0, sigma);
  return link;
}

GridRange range(const GridEnd& placed, const GridEnd& free, const TruePlace& truth, Rng& rng) {
  const SE2 a = pose_of(placed), b = truth.T_placed_free() * pose_of(free);
  return {placed, free, (b.translation() - a.translation()).norm() + rng.normal(0, 0.5), 0.5};
}

TruePlace random_place(Rng& rng) {
  return {rng.uniform(20, 90), rng.uniform(-kHalfTurn_rad, kHalfTurn_rad),
          rng.uniform(-kHalfTurn_rad, kHalfTurn_rad)};
}

GridParams coarse_params() {
  GridParams params;
  params.angle_steps = 36;
  return params;
}

double step(const GridParams& params) { return 2 * kHalfTurn_rad / params.angle_steps; }

bool is_at(const GridCell& cell, const TruePlace& truth, const GridParams& params) {
  return std::abs(wrap_angle(cell.phi_rad - truth.phi_rad)) < 1.5 * step(params) &&
         std::abs(wrap_angle(cell.theta_rad - truth.theta_rad)) < 1.5 * step(params);
}

/// The first link is the reference itself, whose range gives the distance.
GridProblem random_problem(const TruePlace& truth, int links, Rng& rng) {
  GridProblem problem;
  problem.distances = {{truth.distance_m, 0.5}};
  problem.span_m = 200;
  for (int k = 0; k < links; ++k) {
    const GridEnd placed = k == 0 ? GridEnd{} : random_end(rng), free = k == 0 ? GridEnd{} : random_end(rng);
    problem.ranges.push_back(range(placed, free, truth, rng));
    for (const bool by_placed : {true, false})
      problem.bearings.push_back(bearing(placed, free, by_placed, truth, rng));
  }
  return problem;
}

TEST(AlignmentGrid, TheTruePlaceIsTheHighestPeakWithAngles) {
  const GridParams params = coarse_params();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Rng rng(seed);
    const TruePlace truth = random_place(rng);
    const auto peaks = best_cells(random_problem(truth, 8, rng), params);
    ASSERT_FALSE(peaks.empty());
    EXPECT_TRUE(is_at(peaks.front(), truth, params)) << "seed " << seed;
  }
}

TEST(AlignmentGrid, TheTruePlaceIsAmongThePeaksWithRangesOnly) {
  const GridParams params = coarse_params();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Rng rng(seed);
    const TruePlace truth = random_place(rng);
    auto problem = random_problem(truth, 8, rng);
    problem.bearings.clear();
    bool found = false;
    for (const GridCell& peak : best_cells(problem, params)) found = found || is_at(peak, truth, params);
    EXPECT_TRUE(found) << "seed " << seed;
  }
}

TEST(AlignmentGrid, FindsTheDistanceWhereNoneWasMeasured) {
  const GridParams params = coarse_params();
  Rng rng(5);
  const TruePlace truth{48, 1, -2};
  auto problem = random_problem(truth, 8, rng);
  problem.ranges.clear();
  problem.distances = {{12, 3}, {24, 6}, {48, 12}, {96, 24}};
  const auto peaks = best_cells(problem, params);
  ASSERT_FALSE(peaks.empty());
  EXPECT_TRUE(is_at(peaks.front(), truth, params));
  EXPECT_EQ(peaks.front().distance_m, 48);
}

TEST(AlignmentGrid, AKnownHeadingLimitsTheSearch) {
  const GridParams params = coarse_params();
  Rng rng(6);
  auto problem = random_problem(random_place(rng), 2, rng);
  problem.heading = {2.0, 0.1};
  for (const GridCell& peak : best_cells(problem, params))
    EXPECT_LE(std::abs(wrap_angle(peak.theta_rad - 2)), 3 * 0.1 + step(params) + 1e-12);
}

TEST(AlignmentGrid, PeaksAreDifferentPlacesBestFirst) {
  const GridParams params = coarse_params();
  Rng rng(7);
  const auto peaks = best_cells(random_problem(random_place(rng), 3, rng), params);
  ASSERT_EQ(peaks.size(), static_cast<std::size_t>(params.peaks));
  for (std::size_t i = 0; i < peaks.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(peaks[j].score, peaks[i].score);
      const double apart = std::max(std::abs(wrap_angle(peaks[i].phi_rad - peaks[j].phi_rad)),
                                    std::abs(wrap_angle(peaks[i].theta_rad - peaks[j].theta_rad)));
      EXPECT_GT(apart, 2 * step(params)) << "one distance: they must differ in an angle";
    }
}

/// Links of a free end that is `height_m` above where its odometry has it, on ground that slopes with x.
GridProblem raised_problem(const TruePlace& truth, double height_m, double slope, Rng& rng) {
  GridProblem problem = random_problem(truth, 12, rng);
  problem.bearings.clear();
  problem.sigma_height_m = 10;
  for (GridRange& link : problem.ranges) {
    link.placed.height_m = slope * link.placed.position.x();
    link.free.height_m = slope * (truth.T_placed_free() * link.free.position).x();
    link.range_m = std::hypot(link.range_m, height_m + link.free.height_m - link.placed.height_m);
  }
  return problem;
}

GridCell raised_cell(const GridProblem& problem, const TruePlace& truth) {
  return {problem.ranges.front().range_m, 0.5, truth.phi_rad, truth.theta_rad, 0, 10, 0};
}

TEST(AlignmentGrid, RangesOverLevelGroundDoNotTellAboveFromBelow) {
  GridParams params;
  params.angle_steps = 360;
  Rng rng(3);
  const TruePlace truth{40, 1, -2};
  const GridProblem problem = raised_problem(truth, 14, 0, rng);
  const auto levels = at_best_heights(problem, raised_cell(problem, truth), params);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_NEAR(std::abs(levels[0].rise_m), 14, 2.5);
  EXPECT_NEAR(levels[0].rise_m + levels[1].rise_m, 0, 2.5);
  EXPECT_NEAR(levels[0].distance_m, truth.distance_m, 2);
}

TEST(AlignmentGrid, ASlopeTellsAboveFromBelow) {
  GridParams params;
  params.angle_steps = 360;
  for (const double height_m : {-14.0, 14.0}) {
    Rng rng(4);
    const TruePlace truth{40, 1, -2};
    const GridProblem problem = raised_problem(truth, height_m, 0.1, rng);
    const GridCell cell{std::sqrt(truth.distance_m * truth.distance_m + height_m * height_m),
                        0.5,
                        truth.phi_rad,
                        truth.theta_rad,
                        0,
                        10,
                        0};
    EXPECT_NEAR(at_best_heights(problem, cell, params).front().rise_m, height_m, 2.5);
  }
}

TEST(AlignmentGrid, AKnownHeightIsNotSearched) {
  GridProblem problem;
  problem.ranges = {{{}, {}, 40, 0.5}};
  const GridCell cell{40, 0.5, 1, 2, 0, 0, 0};
  const auto levels = at_best_heights(problem, cell, {});
  ASSERT_EQ(levels.size(), 1U);
  EXPECT_EQ(levels[0].distance_m, 40);
}

/// A position and a heading with correlated errors, both drawn.
SE2 drawn(const GridEnd& end, Rng& rng) {
  const Eigen::Matrix3d root = end.covariance.llt().matrixL();
  const Eigen::Vector3d error = root * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
  return {end.position + error.head<2>(), end.heading_rad + error[2]};
}

GridEnd correlated_end(Rng& rng) {
  GridEnd end = random_end(rng);
  end.covariance << 0.5, 0.1, 0.004, 0.1, 0.3, -0.006, 0.004, -0.006, 4e-4;
  end.height_m = rng.uniform(-15, 15);
  return end;
}

struct Sample {
  double range_m, by_placed_rad, by_free_rad;
};

Sample draw(const GridEnd& placed, const GridEnd& free, const GridCell& cell, const GridParams& params,
            Rng& rng) {
  const double width = step(params) / 2;
  const TruePlace place{rng.normal(cell.distance_m, cell.sigma_distance_m),
                        cell.phi_rad + rng.uniform(-width, width),
                        cell.theta_rad + rng.uniform(-width, width)};
  const SE2 a = drawn(placed, rng), b = place.T_placed_free() * drawn(free, rng);
  const double height = rng.normal(free.height_m - placed.height_m, cell.sigma_rise_m);
  return {std::hypot((b.translation() - a.translation()).norm(), height), azimuth(a, b), azimuth(b, a)};
}

TEST(AlignmentGrid, PropagatedVariancesAgreeWithSampling) {
  GridParams params;
  params.angle_steps = 200;  // cells so small that errors are linear
  constexpr int kSamples = 5000;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    const GridEnd placed = correlated_end(rng), free = correlated_end(rng);
    const GridCell cell{rng.uniform(100, 180),
                        1,
                        rng.uniform(-kHalfTurn_rad, kHalfTurn_rad),
                        rng.uniform(-kHalfTurn_rad, kHalfTurn_rad),
                        0,
                        rng.uniform(1, 10)};
    GridProblem problem;
    problem.ranges = {{placed, free, 1, 1}};
    problem.bearings = {{placed, free, true, {0}, {1}, {1}}, {placed, free, false, {0}, {1}, {1}}};
    const VarianceInflation predicted = propagated_variances(problem, cell, params);

    const SE2 a = pose_of(placed),
              b = TruePlace{cell.distance_m, cell.phi_rad, cell.theta_rad}.T_placed_free() * pose_of(free);
    if ((b.translation() - a.translation()).norm() < 40) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
    const double level = (b.translation() - a.translation()).norm();
    for (int k = 0; k < kSamples; ++k) {
      const Sample s = draw(placed, free, cell, params, rng);
      const Eigen::Vector3d error(s.range_m - level, wrap_angle(s.by_placed_rad - azimuth(a, b)),
                                  wrap_angle(s.by_free_rad - azimuth(b, a)));
      sum += error;
      squares += error.cwiseAbs2();
    }
    const Eigen::Vector3d variance = squares / kSamples - (sum / kSamples).cwiseAbs2();
    EXPECT_NEAR(predicted.ranges_m2[0] / variance[0], 1, 0.12) << "seed " << seed;
    EXPECT_NEAR(predicted.bearings_rad2[0] / variance[1], 1, 0.12) << "seed " << seed;
    EXPECT_NEAR(predicted.bearings_rad2[1] / variance[2], 1, 0.12) << "seed " << seed;
  }
}

}  // namespace
}  // namespace radioslam
