#include "radioslam/radio/ranging/anchor_layout.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

/// Distances of all pairs, with noise.
std::vector<AnchorDistance> all_distances(const Eigen::MatrixXd& points, Rng& rng, double sigma_m) {
  std::vector<AnchorDistance> distances;
  for (Eigen::Index j = 0; j < points.cols(); ++j)
    for (Eigen::Index i = 0; i < j; ++i)
      distances.push_back({static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                           (points.col(i) - points.col(j)).norm() + rng.normal(0, sigma_m),
                           sigma_m > 0 ? sigma_m : 0.01});
  return distances;
}

/// Anchors in a hall of 25 x 23 m: the first at the origin, the second on +x, the third to the left.
Eigen::Matrix2Xd hall() {
  Eigen::Matrix2Xd points(2, 5);
  points << 0, 22, 25, 3, 11,  //
      0, 0, 21, 23, 9;
  return points;
}

AnchorLayout laid_out(std::size_t anchors, const std::vector<AnchorDistance>& distances,
                      const AnchorFrame& frame = {}, const AnchorLayoutParams& params = {}) {
  const auto result = estimate_anchor_layout(anchors, distances, frame, params);
  EXPECT_TRUE(std::holds_alternative<AnchorLayout>(result));
  return std::get<AnchorLayout>(result);
}

LayoutFailure refused(std::size_t anchors, const std::vector<AnchorDistance>& distances,
                      const AnchorFrame& frame = {}, const AnchorLayoutParams& params = {}) {
  const auto result = estimate_anchor_layout(anchors, distances, frame, params);
  EXPECT_TRUE(std::holds_alternative<LayoutFailure>(result));
  return std::get<LayoutFailure>(result);
}

TEST(AnchorLayout, ExactDistancesGiveTheAnchorsBack) {
  Rng rng(1);
  const auto layout = laid_out(5, all_distances(hall(), rng, 0));
  EXPECT_LT((layout.positions_m.topRows(2) - hall()).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(layout.positions_m.row(2), Eigen::RowVectorXd::Zero(5));
  EXPECT_EQ(layout.redundancy, 3);
  EXPECT_LT(layout.rms_m, 1e-6);
}

TEST(AnchorLayout, ThreeFourFive) {
  const auto layout = laid_out(3, {{0, 1, 3}, {1, 2, 5}, {0, 2, 4}});
  EXPECT_LT((layout.positions_m.col(1) - Eigen::Vector3d(3, 0, 0)).norm(), 1e-9);
  EXPECT_LT((layout.positions_m.col(2) - Eigen::Vector3d(0, 4, 0)).norm(), 1e-9);
  EXPECT_EQ(layout.redundancy, 0);
}

TEST(AnchorLayout, FrameAndHandednessAreAsRequested) {
  Rng rng(1);
  const auto distances = all_distances(hall(), rng, 0);
  const auto layout = laid_out(5, distances, {3, 1, 0});
  EXPECT_LT(layout.positions_m.col(3).norm(), 1e-9);
  EXPECT_GT(layout.positions_m(0, 1), 0);
  EXPECT_NEAR(layout.positions_m(1, 1), 0, 1e-9);
  EXPECT_GT(layout.positions_m(1, 0), 0) << "as requested, although the first anchor is truly to the right";
  EXPECT_EQ(refused(5, distances, {2, 2, 0}).reason, LayoutRefusal::kFrame);
}

TEST(AnchorLayout, SpaceNeedsFourAnchorsAndFindsThem) {
  Eigen::Matrix3Xd points(3, 6);
  points << 0, 8, 7, 1, 0, 6,  //
      0, 0, 6, 5, 1, 2,        //
      0, 0, 0, 2.5, 3, 1;
  Rng rng(1);
  AnchorLayoutParams params;
  params.dimension = 3;
  const auto layout = laid_out(6, all_distances(points, rng, 0), {}, params);
  EXPECT_LT((layout.positions_m - points).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(AnchorLayout, SigmasAreThoseOfTheErrors) {
  constexpr int kDraws = 300;
  Rng rng(2);
  double normalised = 0, noise = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto layout = laid_out(5, all_distances(hall(), rng, 0.05));
    // Distances leave the frame open: align to the truth by the best rigid motion.
    const Eigen::Matrix2Xd found =
        layout.positions_m.topRows(2).colwise() - layout.positions_m.topRows(2).rowwise().mean();
    const Eigen::Matrix2Xd truth = hall().colwise() - Eigen::Vector2d(hall().rowwise().mean());
    const Eigen::Matrix2d h = truth * found.transpose();
    const double angle = std::atan2(h(1, 0) - h(0, 1), h.trace());
    const Eigen::Matrix2Xd error = Eigen::Rotation2Dd(angle).toRotationMatrix() * found - truth;
    for (Eigen::Index k = 0; k < 5; ++k)
      normalised +=
          error.col(k).squaredNorm() / 2 / std::pow(layout.sigmas_m[static_cast<std::size_t>(k)], 2);
    noise += layout.noise_factor * layout.noise_factor;
  }
  EXPECT_NEAR(noise / kDraws, 1, 0.2);
  // Sigmas are scaled up to the estimated noise, so the ratio is slightly below 1.
  EXPECT_GT(normalised / (5 * kDraws), 0.6);
  EXPECT_LT(normalised / (5 * kDraws), 1.15);
}

TEST(AnchorLayout, OneGrossErrorIsRejected) {
  Rng rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    auto distances = all_distances(hall(), rng, 0.01);
    const auto wrong = static_cast<std::size_t>(rng.below(distances.size()));
    distances[wrong].distance_m += rng.uniform(1, 6);
    const auto layout = laid_out(5, distances);
    EXPECT_LT((layout.positions_m.topRows(2) - hall()).cwiseAbs().maxCoeff(), 0.1) << trial;
    for (std::size_t k = 0; k < distances.size(); ++k) EXPECT_EQ(layout.used[k], k != wrong) << trial;
    EXPECT_GT(std::abs(layout.residuals_m[wrong]), 0.9);
  }
}

TEST(AnchorLayout, NoiseAboveTheStatedOneIsNoGrossError) {
  Rng rng(4);
  int set_aside = 0;
  double factor = 0;
  for (int trial = 0; trial < 50; ++trial) {
    auto distances = all_distances(hall(), rng, 0.05);
    for (auto& distance : distances) distance.sigma_m = 0.005;
    const auto layout = laid_out(5, distances);
    for (const bool used : layout.used) set_aside += used ? 0 : 1;
    factor += layout.noise_factor / 50;
  }
  EXPECT_LE(set_aside, 2);
  EXPECT_NEAR(factor, 10, 2.5);
}

TEST(AnchorLayout, MissingDistancesAreAllowedWhileTheShapeIsRigid) {
  Rng rng(1);
  auto distances = all_distances(hall(), rng, 0);
  distances.erase(distances.begin() + 8);  // 2 - 4
  distances.erase(distances.begin() + 3);  // 0 - 3
  const auto layout = laid_out(5, distances);
  EXPECT_LT((layout.positions_m.topRows(2) - hall()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(AnchorLayout, RefusesWhatIsNoLayout) {
  Rng rng(1);
  EXPECT_EQ(refused(2, {{0, 1, 5}}).reason, LayoutRefusal::kTooFewAnchors);
  const auto disconnected = refused(5, {{0, 1, 3}, {1, 2, 5}, {0, 2, 4}, {3, 4, 1}});
  EXPECT_EQ(disconnected.reason, LayoutRefusal::kDisconnected);
  EXPECT_EQ(disconnected.anchor, 3U);
  const auto loose = refused(4, {{0, 1, 3}, {1, 2, 5}, {0, 2, 4}, {2, 3, 1}});
  EXPECT_EQ(loose.reason, LayoutRefusal::kPoorlyConstrained);
  EXPECT_EQ(loose.anchor, 3U);
}

TEST(AnchorLayout, AnchorsOnALineAreRefused) {
  Eigen::Matrix2Xd line(2, 5);
  line << 0, 4, 9, 15, 22, 0, 2, 4.5, 7.5, 11;
  for (const double sigma_m : {0.0, 0.01, 0.1}) {
    Rng rng(6);
    EXPECT_EQ(refused(5, all_distances(line, rng, sigma_m)).reason, LayoutRefusal::kFlat) << sigma_m;
  }
  Eigen::Matrix2Xd corridor = line;
  corridor.row(1) << 0, 2, 0, 2, 0;
  Rng rng(6);
  const auto layout = laid_out(5, all_distances(corridor, rng, 0.01), {0, 2, 1});
  EXPECT_NEAR(layout.positions_m(1, 1), 2, 0.5) << "narrow but resolvable";
}

}  // namespace
}  // namespace radioslam
