#include "radioslam/joint/aoa/aoa_match_weights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/town_runs.hpp"
#include "radioslam/joint/closures/closure_admission.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Two robots that move along x at 1 m/s, b 10 m to the left of a and ahead by as much; a measures b at 45
/// degrees.
Mission walking() {
  Mission mission;
  for (const char* id : {"a", "b"}) {
    Robot& robot = mission.robots.emplace_back();
    robot.id = id;
    std::vector<StampedPose<SE3>> rows;
    for (int k = 0; k <= 20; ++k) rows.push_back({Stamp{k * kSecond}, lift(SE2({1.0 * k, 0}, 0))});
    robot.odometry = Trajectory<SE3>(std::move(rows));
  }
  return mission;
}

AoaMeasurement heard(std::size_t receiver, double t_s, double azimuth_deg) {
  AoaMeasurement measured;
  measured.stamp = Stamp{static_cast<std::int64_t>(t_s * kSecond)};
  measured.receiver = RobotIndex(receiver);
  measured.transmitter.robot = RobotIndex(1 - receiver);
  measured.paths = {{azimuth_deg * std::numbers::pi / 180, std::nullopt, 0.05, 0}};
  return measured;
}

/// b at t_j as a saw it at t_i.
Closure match(double t_i_s, double t_j_s, const Eigen::Vector2d& position) {
  Closure result;
  result.robot_i = RobotIndex(std::size_t{0});
  result.robot_j = RobotIndex(std::size_t{1});
  result.stamp_i = Stamp{static_cast<std::int64_t>(t_i_s * kSecond)};
  result.stamp_j = Stamp{static_cast<std::int64_t>(t_j_s * kSecond)};
  result.T_i_j = lift(SE2(position, 0));
  result.information = isotropic_covariance(10, 100);
  return result;
}

std::optional<double> scale(const Mission& mission, const Closure& match, const MatchParams& params = {}) {
  return AoaMatchWeights(mission, params, {}).information_scale<SE2>(match);
}

TEST(AoaMatchWeights, KeepWhatAgreesAndDiscountWhatDoesNot) {
  Mission mission = walking();
  mission.aoa_measurements = {heard(0, 10, 45)};
  EXPECT_EQ(scale(mission, match(10, 10, {10, 10})), 1);
  EXPECT_LT(scale(mission, match(10, 10, {10, -10})).value(), 1e-6);
}

TEST(AoaMatchWeights, AreSeenFromTheReceiver) {
  Mission mission = walking();
  mission.aoa_measurements = {heard(1, 10, -135)};
  EXPECT_EQ(scale(mission, match(10, 10, {10, 10})), 1);
  EXPECT_LT(scale(mission, match(10, 10, {10, -10})).value(), 1e-6);
}

/// At 4 s a was 8 m behind where it will be at 12 s, b at 16 s is 4 m ahead: the match gives (22, 10).
TEST(AoaMatchWeights, CarryTheMatchByOdometry) {
  Mission mission = walking();
  mission.aoa_measurements = {heard(0, 12, 45)};
  EXPECT_EQ(scale(mission, match(4, 16, {22, 10})), 1);
  EXPECT_LT(scale(mission, match(4, 16, {10, 10})).value(), 1e-3);
  MatchParams near_only;
  near_only.max_carried_m = 11.9;
  EXPECT_FALSE(scale(mission, match(4, 16, {22, 10}), near_only));
}

TEST(AoaMatchWeights, TheMedianOfTheNearestDecides) {
  Mission mission = walking();
  mission.aoa_measurements = {heard(0, 9, 45), heard(0, 10, -90), heard(0, 11.5, 45), heard(0, 19, -90),
                              heard(0, 20, -90)};
  MatchParams params;
  params.angles = 3;
  EXPECT_EQ(scale(mission, match(10, 10, {10, 10}), params), 1);
  params.angles = 1;
  EXPECT_LT(scale(mission, match(10, 10, {10, 10}), params).value(), 1e-6);
  params.angles = 5;
  EXPECT_LT(scale(mission, match(10, 10, {10, 10}), params).value(), 1e-6);
}

TEST(AoaMatchWeights, OfOtherRobotsAreIgnored) {
  Mission mission = walking();
  EXPECT_FALSE(scale(mission, match(10, 10, {10, 10})));
}

/// A closure that angles exclude is not merely set aside because its views cannot overlap, either.
TEST(AoaMatchWeights, ExcludeWhicheverPairsAreCandidates) {
  Mission mission = walking();
  mission.aoa_measurements = {heard(0, 10, 45)};
  const auto joint = build_joint_graph<SE2>(mission, {.distance_m = 0.9}, {});
  TeamAlignment<SE2> alignment;
  alignment.component = alignment.without_matches = {0, 0};
  std::vector<std::vector<Stamp>> stamps;
  for (const RobotVariables& robot : joint.robots) stamps.push_back(robot.stamps);
  const CandidateList none(std::move(stamps));
  const AoaMatchWeights angles(mission, {}, {});
  const auto admitted = admit_closures<SE2>(
      joint, alignment, {match(10, 10, {10, -10}), match(10, 10, {10, 10})}, &none, {}, &angles);
  EXPECT_EQ(admitted[0].admission, Admission::kExcluded);
  EXPECT_EQ(admitted[1].admission, Admission::kSetAside);
}

/// Under least squares, where aliases that survive the pruning distort the map.
TEST(AoaMatchWeights, SparePlainLeastSquaresFromAliases) {
  CityParams city;
  city.matches.matches_true = 40;
  city.matches.matches_false = 120;
  const auto [mission, truth] = simulate_city(city, 1);
  RunParams params = test::quick_params();
  params.matches.robust = false;
  const RunOutput plain = run_pipeline(mission, params);
  const double without_m = test::error_m(plain.result, truth);
  params.matches.angle_weights = true;
  const RunOutput output = run_pipeline(mission, params);
  const RunResult& weighed = output.result;
  EXPECT_GT(without_m, 8);
  EXPECT_LT(test::error_m(weighed, truth), without_m / 3);
  EXPECT_TRUE(std::any_of(weighed.closures.begin(), weighed.closures.end(), [](const ClosureResult& closure) {
    return closure.reason == "the angles of arrival disagree";
  }));
  const auto beside_closures = [](const RunOutput& out) {
    const auto accepted = std::count_if(
        out.result.closures.begin(), out.result.closures.end(),
        [](const ClosureResult& closure) { return closure.status == ClosureStatus::kAccepted; });
    return static_cast<std::ptrdiff_t>(std::get<PoseGraph2>(out.graph).relative_poses.size()) - accepted;
  };
  EXPECT_EQ(beside_closures(output), beside_closures(plain)) << "what counts as rejected is not in the graph";
}

}  // namespace
}  // namespace radioslam
