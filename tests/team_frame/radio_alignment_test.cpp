// Alignment of teams by their links alone, compared with an oracle: maximum likelihood that knows which paths
// are direct and starts from the truth. Bounds are those of the whole program, on shorter trajectories.
#include "radioslam/team_frame/radio_alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <ostream>
#include <string>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "team_frame/radio_worlds.hpp"

namespace radioslam {
namespace {

using test::RadioWorld;
using test::SimulatedTeam;

/// 600 m of path and 25 links per pair of robots.
RadioWorld short_world() {
  RadioWorld world;
  world.route_m = 600;
  world.blocks = 4;
  world.links = 25;
  return world;
}

/// Fewer start poses: as accurate on such small teams, and several times as fast.
RadioAlignmentParams quick_params() {
  RadioAlignmentParams params;
  params.mixture.max_range_m = 100;  // as in the worlds
  params.grid.references = 4;
  params.grid.angle_steps = 36;
  params.beam.tried_places = 24;
  params.beam.refined_places = 6;
  return params;
}

RadioAlignment<SE2> align(const TeamGraph<SE2>& team) { return align_by_radio(team, quick_params()); }

/// RMSE of the positions of poses [first, first + count) after one rigid alignment.
double aligned_error_m(const std::vector<SE2>& estimate, const std::vector<SE2>& truth, std::size_t first,
                       std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::Matrix2Xd from(2, n), to(2, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    from.col(k) = estimate[first + static_cast<std::size_t>(k)].translation();
    to.col(k) = truth[first + static_cast<std::size_t>(k)].translation();
  }
  const SE2 T = align_points(from, to);
  const Eigen::Matrix2Xd moved = (T.rotation_matrix() * from).colwise() + T.translation();
  return std::sqrt((moved - to).colwise().squaredNorm().mean());
}

double aligned_error_m(const std::vector<SE2>& estimate, const std::vector<SE2>& truth) {
  return aligned_error_m(estimate, truth, 0, truth.size());
}

/// The same without alignment.
double error_m(const std::vector<SE2>& estimate, const std::vector<SE2>& truth) {
  double squares = 0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    squares += (estimate[k].translation() - truth[k].translation()).squaredNorm();
  return std::sqrt(squares / static_cast<double>(truth.size()));
}

double best_error_m(const RadioAlignment<SE2>& alignment, const std::vector<SE2>& truth) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& hypothesis : alignment.hypotheses)
    best = std::min(best, aligned_error_m(hypothesis.poses, truth));
  return best;
}

double oracle_error_m(const SimulatedTeam& simulated) {
  auto graph = simulated.team.graph;
  graph.poses = simulated.truth;
  for (std::size_t k = 0; k < graph.ranges.size(); ++k)
    graph.ranges[k].weight = simulated.in_sight[k] ? 1 : 0;
  for (std::size_t k = 0; k < simulated.team.bearings.size(); ++k) {
    const auto& bearing = simulated.team.bearings[k];
    const int direct = simulated.direct_path[k];
    if (direct < 0) continue;
    const auto& path = bearing.paths[static_cast<std::size_t>(direct)];
    graph.bearings.push_back({bearing.i, bearing.j, path.direction, path.sigma_rad, {}, 1});
  }
  optimize(graph, {});
  return aligned_error_m(graph.poses, simulated.truth);
}

/// Bound: factor times the oracle's error plus the extra. Two cases bound only the worst single mission.
struct Case {
  std::string name;
  RadioWorld world;
  double ratio, extra_m;
};

Case make_case(const std::string& name, double ratio, double extra_m, void (*change)(RadioWorld&)) {
  Case result{name, short_world(), ratio, extra_m};
  change(result.world);
  return result;
}

void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }

std::vector<Case> cases() {
  return {make_case("BothEnds", 1.05, 0.05, [](RadioWorld&) {}),
          make_case("OneEnd", 1.1, 0.1, [](RadioWorld& w) { w.angle_ends = 1; }),
          make_case("RangesOnly", 1.05, 0.1, [](RadioWorld& w) { w.angle_ends = 0; }),
          make_case("AnglesOnly", 2, 0, [](RadioWorld& w) { w.ranges = false; }),
          make_case("ThreeRobots", 1.1, 0.1, [](RadioWorld& w) { w.robots = 3; }),
          make_case("DelayedAngles", 1.1, 0.1, [](RadioWorld& w) { w.angle_delay_poses = 4; }),
          make_case("MirrorImages", 1.4, 0, [](RadioWorld& w) { w.mirror = true; })};
}

class AlignByRadioCases : public testing::TestWithParam<std::tuple<Case, std::uint64_t>> {};

TEST_P(AlignByRadioCases, IsAsGoodAsTheOracle) {
  const auto& [world, seed] = GetParam();
  const auto simulated = test::simulate_team(world.world, seed);
  const auto alignment = align(simulated.team);
  const double oracle_m = oracle_error_m(simulated);
  EXPECT_LE(best_error_m(alignment, simulated.truth), world.ratio * oracle_m + world.extra_m)
      << "oracle " << oracle_m << " m, " << alignment.hypotheses.size() << " hypotheses";
  EXPECT_EQ(alignment.components.of_segment, std::vector<int>(simulated.team.segments.size(), 0));
  double weights = 0;
  for (const auto& hypothesis : alignment.hypotheses) weights += hypothesis.weight;
  EXPECT_NEAR(weights, 1, 1e-9);
}

std::string name_of(const testing::TestParamInfo<std::tuple<Case, std::uint64_t>>& which) {
  return std::get<0>(which.param).name + std::to_string(std::get<1>(which.param));
}

INSTANTIATE_TEST_SUITE_P(Worlds, AlignByRadioCases,
                         testing::Combine(testing::ValuesIn(cases()), testing::Values(1U, 2U)), name_of);

TEST(AlignByRadio, SeparatesDirectPathsFromMultipath) {
  const auto simulated = test::simulate_team(short_world(), 3);
  const auto best = align(simulated.team).hypotheses.front();
  std::vector<double> direct, other;
  for (std::size_t k = 0; k < simulated.direct_path.size(); ++k)
    for (std::size_t p = 0; p < best.path_weight[k].size(); ++p)
      (static_cast<int>(p) == simulated.direct_path[k] ? direct : other).push_back(best.path_weight[k][p]);
  const auto mean = [](const std::vector<double>& weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  };
  ASSERT_GT(other.size(), 50U);
  EXPECT_GT(mean(direct), 0.7);
  EXPECT_LT(mean(other), 0.1) << "some happen to come from about where the other robot is";
  EXPECT_GT(*std::min_element(best.range_weight.begin(), best.range_weight.end()), 0.5) << "all are direct";
}

/// 1.2 km of path and 60 links, most of them round corners.
RadioWorld street_world() {
  RadioWorld world;
  world.route_m = 1200;
  world.blocks = 3;
  world.links = 60;
  world.radio_reach_m = 150;
  world.corners = true;
  return world;
}

std::size_t links_in_sight(const SimulatedTeam& simulated) {
  return static_cast<std::size_t>(std::count(simulated.in_sight.begin(), simulated.in_sight.end(), true));
}

TEST(AlignByRadio, DetoursRoundCornersAreNotTakenForDirectLinks) {
  std::size_t missions = 0, as_good = 0, as_good_without = 0;
  for (std::uint64_t seed = 1; missions < 6; ++seed) {
    const auto simulated = test::simulate_team(street_world(), seed);
    const std::size_t in_sight = links_in_sight(simulated);
    if (in_sight < 12 || in_sight > 30) continue;
    ++missions;
    const double oracle_m = oracle_error_m(simulated), bound_m = 1.3 * oracle_m + 0.2;
    RadioAlignmentParams params;
    params.mixture.max_range_m = 150;
    const auto best = align_by_radio(simulated.team, params).hypotheses.front();
    const double error_m = aligned_error_m(best.poses, simulated.truth);
    as_good += error_m <= bound_m ? 1U : 0U;
    EXPECT_TRUE(error_m <= 2 * oracle_m || best.weight < 0.9)
        << "seed " << seed << ", " << in_sight << " of 60 links in sight: " << error_m << " m, oracle "
        << oracle_m << " m, weight " << best.weight;
    params.mixture.obstructed_share = 0;
    const auto naive = align_by_radio(simulated.team, params).hypotheses.front();
    as_good_without += aligned_error_m(naive.poses, simulated.truth) <= bound_m ? 1U : 0U;
  }
  EXPECT_GE(as_good, 4U) << "of 6";
  EXPECT_LE(as_good_without, 2U) << "or the missions are easy without a model of detours, too";
}

/// Removes the measurements of one robot.
void cut_off(TeamGraph<SE2>& team, std::size_t segment) {
  const auto of = segment_of_poses(team);
  std::erase_if(team.graph.ranges, [&](const auto& f) {
    return of[f.i.pose.index()] == segment || of[f.j.pose.index()] == segment;
  });
  std::erase_if(team.bearings,
                [&](const auto& f) { return of[f.i.index()] == segment || of[f.j.pose.index()] == segment; });
}

TEST(AlignByRadio, ARobotWithoutLinksStaysInItsOwnComponent) {
  RadioWorld world = short_world();
  world.robots = 3;
  auto simulated = test::simulate_team(world, 4);
  cut_off(simulated.team, 1);
  const auto alignment = align(simulated.team);
  EXPECT_EQ(alignment.components.of_segment, (std::vector<int>{0, 1, 0}));
  const auto& poses = alignment.hypotheses.front().poses;
  const TrajectorySegment& alone = simulated.team.segments[1];
  for (std::size_t k = alone.first_pose; k < alone.first_pose + alone.pose_count; ++k)
    ASSERT_LT((poses[k].inverse() * simulated.team.graph.poses[k]).log().norm(), 1e-6);
  std::vector<SE2> estimate, truth;
  for (const std::size_t p : {0U, 2U}) {
    const TrajectorySegment& segment = simulated.team.segments[p];
    for (std::size_t k = segment.first_pose; k < segment.first_pose + segment.pose_count; ++k) {
      estimate.push_back(poses[k]);
      truth.push_back(simulated.truth[k]);
    }
  }
  EXPECT_LT(aligned_error_m(estimate, truth), 2);
}

/// Puts the segment at its true start, with a prior.
void add_known_start(SimulatedTeam& simulated, std::size_t segment) {
  TrajectorySegment& known = simulated.team.segments[segment];
  known.in_common_frame = true;
  auto& graph = simulated.team.graph;
  const SE2 T_common_start = simulated.truth[known.first_pose] * graph.poses[known.first_pose].inverse();
  for (std::size_t k = known.first_pose; k < known.first_pose + known.pose_count; ++k)
    graph.poses[k] = T_common_start * graph.poses[k];
  PosePriorFactor<SE2> prior{PoseId(known.first_pose), graph.poses[known.first_pose], {}, {}, 1};
  prior.information = Eigen::Vector3d(400, 400, 1e4).asDiagonal();  // 0.05 m, 0.01 rad
  graph.pose_priors.push_back(prior);
}

TEST(AlignByRadio, KeepsKnownStartsAndPlacesTheOthersInTheirFrame) {
  auto simulated = test::simulate_team(short_world(), 5);
  add_known_start(simulated, 1);
  const auto poses = align(simulated.team).hypotheses.front().poses;
  const std::size_t first = simulated.team.segments[1].first_pose;
  const SE2::Tangent moved = (simulated.truth[first].inverse() * poses[first]).log();
  EXPECT_LT(moved.head<2>().norm(), 0.15);
  EXPECT_LT(std::abs(moved[2]), 0.03);
  EXPECT_LT(error_m(poses, simulated.truth), 4);
}

TEST(AlignByRadio, KnownStartsDoNotHideLinksAfterLongDrift) {
  RadioWorld world;
  world.angle_ends = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    auto simulated = test::simulate_team(world, seed);
    for (auto& factor : simulated.team.graph.relative_poses)  // 0.06 rad per kilometre
      factor.T_i_j = factor.T_i_j * SE2({0, 0}, 6e-5 * factor.T_i_j.translation().norm());
    for (std::size_t p = 0; p < simulated.team.segments.size(); ++p) {
      const TrajectorySegment& segment = simulated.team.segments[p];
      for (std::size_t k = segment.first_pose + 1; k < segment.first_pose + segment.pose_count; ++k)
        simulated.team.graph.poses[k] =
            simulated.team.graph.poses[k - 1] * simulated.team.graph.relative_poses[k - 1 - p].T_i_j;
      add_known_start(simulated, p);
    }
    std::erase_if(simulated.team.graph.ranges, [&](const auto& range) {
      return range.i.pose.index() < simulated.team.segments[0].pose_count / 2;
    });
    const auto alignment = align(simulated.team);
    const auto& weights = alignment.hypotheses.front().range_weight;
    const double direct = std::accumulate(weights.begin(), weights.end(), 0.0);
    EXPECT_GE(direct, 0.9 * static_cast<double>(weights.size())) << "seed " << seed;
  }
}

/// Odometry along a straight line: `steps` of 2 m from `start`.
void drive_straight(SimulatedTeam& result, const std::string& robot, const SE2& start, std::size_t steps) {
  auto& graph = result.team.graph;
  TrajectorySegment segment{robot, graph.poses.size(), steps + 1, {}};
  const SE2 step({2, 0}, 0);
  for (std::size_t k = 0; k <= steps; ++k) {
    segment.stamps.push_back(Stamp::from_seconds(static_cast<double>(k)));
    graph.poses.push_back(k == 0 ? SE2() : graph.poses.back() * step);
    result.truth.push_back(k == 0 ? start : result.truth.back() * step);
    if (k == 0) continue;
    RelativePoseFactor<SE2> factor{PoseId(graph.poses.size() - 2), PoseId(graph.poses.size() - 1), step};
    factor.information = Eigen::Vector3d(1e3, 1e3, 1e5).asDiagonal();
    graph.relative_poses.push_back(factor);
  }
  result.team.segments.push_back(segment);
}

/// The ranges depend on b's start and heading in a's frame through |c + 2 k w|, w = u(heading) - e_x: both
/// signs of the heading give the same |w|, and c may be on either side of w.
std::vector<SE2> places_with_these_ranges(const SE2& T_a_b) {
  std::vector<SE2> places;
  for (const double sign : {1.0, -1.0}) {
    const double heading = sign * T_a_b.angle();
    const Eigen::Vector2d c(T_a_b.translation().x(), sign * T_a_b.translation().y());
    const Eigen::Vector2d w = Eigen::Vector2d(std::cos(heading) - 1, std::sin(heading)).normalized();
    places.emplace_back(c, heading);
    places.emplace_back(2 * w.dot(c) * w - c, heading);
  }
  return places;
}

TEST(AlignByRadio, PlacesThatFitAsWellAreHypothesesOfEqualWeight) {
  SimulatedTeam simulated;
  constexpr std::size_t kSteps = 40;
  const SE2 T_a_b({60, 40}, -2.5);
  drive_straight(simulated, "a", SE2(), kSteps);
  drive_straight(simulated, "b", T_a_b, kSteps);
  Rng rng(1);
  for (std::size_t k = 0; k <= kSteps; k += 2) {
    RangeFactor<SE2> range;
    range.i.pose = PoseId(k);
    range.j.pose = PoseId(kSteps + 1 + k);
    range.sigma_m = 0.3;
    const Eigen::Vector2d apart =
        simulated.truth[range.j.pose.index()].translation() - simulated.truth[k].translation();
    range.range_m = rng.normal(apart.norm(), range.sigma_m);
    simulated.team.graph.ranges.push_back(range);
  }
  const auto alignment = align(simulated.team);
  const auto places = places_with_these_ranges(T_a_b);
  ASSERT_EQ(alignment.hypotheses.size(), places.size());
  for (const SE2& place : places) {
    const auto fits = [&](const auto& hypothesis) {
      const SE2 estimate = hypothesis.poses[0].inverse() * hypothesis.poses[kSteps + 1];
      return (estimate.translation() - place.translation()).norm() < 4 &&
             std::abs(wrap_angle(estimate.angle() - place.angle())) < 0.1;
    };
    EXPECT_EQ(std::count_if(alignment.hypotheses.begin(), alignment.hypotheses.end(), fits), 1)
        << place.translation().transpose() << ", " << place.angle();
  }
  for (const auto& hypothesis : alignment.hypotheses) EXPECT_NEAR(hypothesis.weight, 0.25, 0.05);
}

/// One of three paths at either end: nine poses of b, all with the same range.
TEST(AlignByRadio, OneLinkLeavesEveryPairOfItsPathsOpen) {
  SimulatedTeam simulated;
  constexpr std::size_t kSteps = 20, kLinked = 10;
  drive_straight(simulated, "a", SE2(), kSteps);
  drive_straight(simulated, "b", SE2({60, 40}, -2.5), kSteps);
  const PoseId a(kLinked), b(kSteps + 1 + kLinked);
  const SE2 T_a_b = simulated.truth[a.index()].inverse() * simulated.truth[b.index()];
  RangeFactor<SE2> range;
  range.i.pose = a;
  range.j.pose = b;
  range.range_m = T_a_b.translation().norm();
  range.sigma_m = 0.3;
  simulated.team.graph.ranges.push_back(range);
  for (const auto& [i, j, seen] : {std::tuple(a, b, T_a_b), std::tuple(b, a, T_a_b.inverse())}) {
    AmbiguousBearing<SE2> bearing;
    bearing.i = i;
    bearing.j.pose = j;
    const double direct = std::atan2(seen.translation().y(), seen.translation().x());
    for (const double azimuth : {direct, direct + 1.8, direct - 2})
      bearing.paths.push_back({{std::cos(azimuth), std::sin(azimuth)}, 0.05, -50});
    simulated.team.bearings.push_back(bearing);
  }
  const auto alignment = align_by_radio(simulated.team, RadioAlignmentParams{});
  EXPECT_EQ(alignment.hypotheses.size(), 9U);
  EXPECT_LT(best_error_m(alignment, simulated.truth), 0.5);
  for (const auto& hypothesis : alignment.hypotheses) EXPECT_NEAR(hypothesis.weight, 1 / 9.0, 0.03);
}

TEST(AlignByRadio, HypothesesDifferByMoreThanTheirFrame) {
  RadioWorld world = short_world();
  world.robots = 3;
  world.links = 10;
  world.angle_ends = 1;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SimulatedTeam simulated = test::simulate_team(world, seed);
    const std::size_t poses_of_first = simulated.team.segments[0].pose_count;
    std::size_t links_of_first = 0;
    const auto every_second = [&](PoseId i) {
      return i.index() < poses_of_first && ++links_of_first % 2 == 0;
    };
    std::erase_if(simulated.team.graph.ranges, [&](const auto& range) { return every_second(range.i.pose); });
    std::erase_if(simulated.team.bearings, [&](const auto& bearing) { return every_second(bearing.i); });
    const auto alignment = align(simulated.team);
    const std::vector<int> together(simulated.team.segments.size(), 0);
    if (alignment.components.of_segment != together) continue;
    const auto& found = alignment.hypotheses;
    for (std::size_t i = 0; i < found.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT(aligned_error_m(found[i].poses, found[j].poses), 0.1)
            << "seed " << seed << ", hypotheses " << j << " and " << i;
  }
}

TEST(AlignByRadio, LargeTeamsPlacedByNeighboursAreWhereTheWholeSearchPutsThem) {
  RadioWorld world = short_world();
  world.robots = 5;
  for (const std::uint64_t seed : {1U, 2U}) {
    const SimulatedTeam simulated = test::simulate_team(world, seed);
    RadioAlignmentParams params = quick_params();
    params.beam.joint_segments = 4;
    const auto local = align_by_radio(simulated.team, params);
    params.beam.joint_segments = 5;
    const auto whole = align_by_radio(simulated.team, params);
    EXPECT_EQ(local.components.of_segment, std::vector<int>(5, 0));
    const double difference_m =
        aligned_error_m(local.hypotheses.front().poses, whole.hypotheses.front().poses);
    EXPECT_LT(difference_m, 0.3) << "seed " << seed;
    EXPECT_LT(aligned_error_m(local.hypotheses.front().poses, simulated.truth), 3) << "seed " << seed;
  }
}

TEST(AlignByRadio, ALargeTeamWithoutLinksToOneRobotLeavesItInItsOwnComponent) {
  RadioWorld world = short_world();
  world.robots = 5;
  SimulatedTeam simulated = test::simulate_team(world, 3);
  const TrajectorySegment last = simulated.team.segments.back();
  const auto of_last = [&](PoseId pose) { return pose.index() >= last.first_pose; };
  std::erase_if(simulated.team.graph.ranges,
                [&](const auto& r) { return of_last(r.i.pose) || of_last(r.j.pose); });
  std::erase_if(simulated.team.bearings, [&](const auto& b) { return of_last(b.i) || of_last(b.j.pose); });
  const auto alignment = align(simulated.team);
  EXPECT_EQ(alignment.components.of_segment, (std::vector<int>{0, 0, 0, 0, 1}));
}

TEST(AlignByRadio, GivesTheSameNumbersForAnyNumberOfThreads) {
  const auto simulated = test::simulate_team(short_world(), 6);
  set_thread_count(1);
  const auto one = align(simulated.team);
  set_thread_count(2);
  const auto two = align(simulated.team);
  set_thread_count(0);
  ASSERT_EQ(one.hypotheses.size(), two.hypotheses.size());
  for (std::size_t h = 0; h < one.hypotheses.size(); ++h) {
    EXPECT_EQ(one.hypotheses[h].weight, two.hypotheses[h].weight);
    EXPECT_EQ(one.hypotheses[h].path_weight, two.hypotheses[h].path_weight);
    for (std::size_t k = 0; k < one.hypotheses[h].poses.size(); ++k) {
      ASSERT_EQ(one.hypotheses[h].poses[k].translation(), two.hypotheses[h].poses[k].translation());
      ASSERT_EQ(one.hypotheses[h].poses[k].angle(), two.hypotheses[h].poses[k].angle());
    }
  }
}

}  // namespace
}  // namespace radioslam
