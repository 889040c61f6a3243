#include <gtest/gtest.h>

#include <algorithm>

#include "radio/aoa/waves.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {
namespace {

using namespace waves;

/// 1 where the two are equal up to a global sign.
double likeness(const Eigen::MatrixXcd& h, const Eigen::MatrixXcd& truth) {
  return std::abs((h.conjugate().cwiseProduct(truth)).sum().real()) / (h.norm() * truth.norm());
}

Eigen::MatrixXcd squared(const Eigen::MatrixXcd& h) { return h.cwiseProduct(h); }

double largest(const Eigen::MatrixXcd& h) { return h.cwiseAbs().maxCoeff(); }

TEST(SquareRootChannel, OfTwoWavesIsTheChannel) {
  const Eigen::MatrixXcd truth =
      array_of({{{0.5, 0, 0}, 0, 1}, {{2, 0, 0}, 5e-8, 0.7}}, arc(480, 0.5, 2)).channel;
  const Eigen::MatrixXcd h = square_root_channel(squared(truth));
  EXPECT_LT(largest(squared(h) - squared(truth)), 1e-12);
  EXPECT_GT(likeness(h, truth), 1 - 1e-12);
  EXPECT_LT(likeness(squared(truth).cwiseSqrt(), truth), 0.9) << "or the test shows nothing";
}

// Three waves cancel at isolated points of time and frequency, and the tree can lead around each.
TEST(SquareRootChannel, GoesAroundAFade) {
  const Eigen::MatrixXcd truth =
      array_of({{{0.5, 0, 0}, 0, 1}, {{0.9, 0, 0}, 1e-7, 0.6}, {{2, 0, 0}, -6e-8, 0.6}}, arc(1600, 0.5, 1.6))
          .channel;
  ASSERT_LT(truth.cwiseAbs().minCoeff(), 0.02) << "or the test shows nothing";
  EXPECT_GT(likeness(square_root_channel(squared(truth)), truth), 0.999);
}

// Where neighbours differ by less than their magnitude, every link between them has the right sign, and so
// has every tree: one wave of amplitude 1, others of 0.8 in total, and phase steps of 0.1 rad over two
// packets.
TEST(SquareRootChannel, OfAnyChannelWithOneStrongWaveIsExact) {
  Rng rng(7);
  for (int trial = 0; trial < 25; ++trial) {
    std::vector<Wave> mixed{{{rng.uniform(-3, 3), 0, 0}, 0, 1}};
    const auto others = 1 + rng.below(5);
    for (std::uint64_t k = 0; k < others; ++k)
      mixed.push_back({{rng.uniform(-3, 3), rng.uniform(-0.5, 0.5), rng.uniform(0, 0.4)},
                       rng.uniform(0, 5e-8),
                       std::polar(0.8 / static_cast<double>(others), rng.uniform(-3, 3))});
    const Eigen::MatrixXcd truth = array_of(mixed, arc(500, rng.uniform(0.08, 0.14), 1.5)).channel;
    const Eigen::MatrixXcd h = square_root_channel(squared(truth));
    EXPECT_LT(largest(squared(h) - squared(truth)), 1e-12);
    EXPECT_GT(likeness(h, truth), 1 - 1e-9) << trial;
  }
}

TEST(SquareRootChannel, OfManyWavesIsTheChannelNearlyEverywhere) {
  Rng rng(8);
  std::vector<double> likenesses;
  for (int trial = 0; trial < 11; ++trial) {
    std::vector<Wave> mixed;
    for (int k = 0; k < 6; ++k)
      mixed.push_back({{rng.uniform(-3, 3), 0, 0}, rng.uniform(0, 8e-8), {rng.normal(), rng.normal()}});
    const Eigen::MatrixXcd truth = array_of(mixed, arc(600, 0.4, 1)).channel;
    const Eigen::MatrixXcd h = square_root_channel(squared(truth));
    EXPECT_LT(largest(squared(h) - squared(truth)), 1e-10);
    likenesses.push_back(likeness(h, truth));
  }
  std::nth_element(likenesses.begin(), likenesses.begin() + 5, likenesses.end());
  EXPECT_GT(likenesses[5], 0.99);
}

TEST(SquareRootChannel, OfOneValueAndOfZerosIsDefined) {
  Eigen::MatrixXcd one(1, 1);
  one(0, 0) = {0, 4};
  EXPECT_LT(std::abs(squared(square_root_channel(one))(0, 0) - one(0, 0)), 1e-12);
  EXPECT_EQ(square_root_channel(Eigen::MatrixXcd::Zero(5, 3)).norm(), 0);
}

}  // namespace
}  // namespace radioslam
