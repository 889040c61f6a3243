#include "radioslam/team_frame/layout_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

constexpr std::size_t kBodies = 9, kPoints = 5;

/// Short walks on a grid 20 m wide, 5 m apart from end to end.
std::vector<RigidBody> grid() {
  std::vector<RigidBody> bodies(kBodies);
  for (std::size_t b = 0; b < kBodies; ++b) {
    bodies[b].first_node = b * kPoints;
    bodies[b].points.resize(2, kPoints);
    for (Eigen::Index i = 0; i < bodies[b].points.cols(); ++i)
      bodies[b].points.col(i) = Eigen::Vector2d(static_cast<double>(i) - 2, 0);
    bodies[b].T_layout_body =
        SE2(Eigen::Vector2d(20 * static_cast<double>(b % 3), 20 * static_cast<double>(b / 3)), 0.3);
  }
  return bodies;
}

std::vector<RigidBody> moved(std::vector<RigidBody> bodies, const SE2& T) {
  for (RigidBody& body : bodies) body.T_layout_body = T * body.T_layout_body;
  return bodies;
}

std::vector<RigidBody> with_first_at(std::vector<RigidBody> bodies, const Eigen::Vector2d& shift_m) {
  bodies[0].T_layout_body =
      SE2(bodies[0].T_layout_body.translation() + shift_m, bodies[0].T_layout_body.angle());
  return bodies;
}

const std::vector<std::size_t> kOneGroup(kBodies, 0);

LayoutParams of_known_size() {
  LayoutParams params;
  params.sigma_size = 0;
  return params;
}

TEST(SecondHalf, KeepsTheNetworksOfABoxTogetherAndHalvesTheBoxes) {
  EXPECT_EQ(second_half({"00:11:22:33:44:50", "00:11:22:33:44:51", "00:11:22:33:44:60", "00:11:22:33:44:6f",
                         "00:11:22:33:44:70"}),
            (std::vector<bool>{false, false, true, true, false}));
  EXPECT_TRUE(second_half({}).empty());
}

TEST(CentreMoves, AreThoseOfOneBodyWhereverTheOthersLie) {
  const auto layout = grid();
  const auto other = moved(with_first_at(layout, {12, 16}), SE2(Eigen::Vector2d(100, -40), 2));
  const auto moves = centre_moves_m(layout, other, kOneGroup);
  EXPECT_NEAR(moves[0], 20, 0.2);
  for (std::size_t b = 1; b < kBodies; ++b) EXPECT_NEAR(moves[b], 0, 0.2);
}

TEST(CentreMoves, AreMeasuredInTheFrameOfFixedBodies) {
  auto layout = grid();
  layout[4].fixed = true;
  for (const double move : centre_moves_m(layout, moved(layout, SE2(Eigen::Vector2d(3, 4), 0)), kOneGroup))
    EXPECT_NEAR(move, 5, 1e-9);
}

TEST(CentreMoves, ComparesEveryGroupInItsOwnFrame) {
  const auto layout = grid();
  auto other = layout;
  std::vector<std::size_t> group_of = kOneGroup;
  for (std::size_t b = 5; b < kBodies; ++b) {
    group_of[b] = 5;
    other[b].T_layout_body = SE2(Eigen::Vector2d(30, 7), -1) * other[b].T_layout_body;
  }
  for (const double move : centre_moves_m(layout, other, group_of)) EXPECT_NEAR(move, 0, 1e-6);
}

TEST(LayoutSigmas, AreWhatHalvesDisagreeOnBeyondTheReachOfNearFingerprints) {
  const auto layout = grid();
  const auto sigmas =
      layout_sigmas_m(layout, {{{with_first_at(layout, {20, 0}), 0}}, {{with_first_at(layout, {0, 5}), 0}}},
                      {}, kOneGroup, of_known_size());
  EXPECT_NEAR(sigmas[0], std::sqrt((400.0 + 25) / 2 - 36), 0.3);
  for (std::size_t b = 1; b < kBodies; ++b) EXPECT_EQ(sigmas[b], 0);
}

TEST(LayoutSigmas, TakesTheMirrorImageThatAgrees) {
  const auto layout = grid();
  auto mirrored = layout;
  for (RigidBody& body : mirrored) {
    const Eigen::Vector2d at = body.T_layout_body.translation();
    body.T_layout_body = SE2(Eigen::Vector2d(at.x(), -3 * at.y()), body.T_layout_body.angle());
  }
  for (const double sigma :
       layout_sigmas_m(layout, {{{mirrored, 0}, {layout, 100}}}, {}, kOneGroup, of_known_size()))
    EXPECT_EQ(sigma, 0);
}

TEST(LayoutSigmas, TakesTheMirrorImageThatAgreesThoughMostStartsAreKnown) {
  auto layout = grid();
  for (std::size_t b = 0; b < 6; ++b) layout[b].fixed = true;
  auto other = layout;
  for (std::size_t b = 6; b < kBodies; ++b)
    other[b].T_layout_body = SE2(Eigen::Vector2d(0, 30), 0) * other[b].T_layout_body;
  for (const double sigma :
       layout_sigmas_m(layout, {{{other, 0}, {layout, 100}}}, {}, kOneGroup, of_known_size()))
    EXPECT_EQ(sigma, 0);
}

TEST(LayoutSigmas, GrowWithTheDistanceFromTheMiddleBeyondWhatTheRobotCovered) {
  auto layout = grid();
  layout[8].points *= 20;  // reaches 40 m
  const LayoutParams params;
  const auto sigmas = layout_sigmas_m(layout, {{{layout, 0}}}, {}, kOneGroup, params);
  EXPECT_NEAR(sigmas[0], params.sigma_size * (std::hypot(20, 20) - 2), 1e-9);
  EXPECT_NEAR(sigmas[1], params.sigma_size * 18, 1e-9);
  EXPECT_EQ(sigmas[4], 0);
  EXPECT_EQ(sigmas[8], 0);
}

TEST(LayoutSigmas, HoldAlternativesByTheirLikelihood) {
  const auto layout = grid();
  const auto alternative = with_first_at(layout, {30, 0});
  const auto with_cost = [&](double cost) {
    return layout_sigmas_m(layout, {{{layout, 0}}},
                           {{centre_moves_m(layout, alternative, kOneGroup), std::exp(-cost)}}, kOneGroup,
                           of_known_size())[0];
  };
  EXPECT_NEAR(with_cost(0), std::sqrt(0.5 * 900 / 2), 0.3);
  EXPECT_NEAR(with_cost(std::log(3)), std::sqrt(0.25 * 900 / 2), 0.3);
  EXPECT_LT(with_cost(30), 1e-3);
}

TEST(LayoutSigmas, AreZeroForKnownStartsAndRobotsOnTheirOwn) {
  auto layout = grid();
  layout[0].fixed = true;
  std::vector<std::size_t> group_of = kOneGroup;
  group_of[8] = 8;
  auto other = layout;
  for (const std::size_t b : {0U, 8U}) other[b].T_layout_body = SE2(Eigen::Vector2d(500, 500), 0);
  const auto sigmas = layout_sigmas_m(layout, {{{other, 0}}}, {}, group_of, {});
  EXPECT_EQ(sigmas[0], 0);
  EXPECT_EQ(sigmas[8], 0);
  EXPECT_GT(sigmas[2], 0);
}

}  // namespace
}  // namespace radioslam
