#include "radioslam/graph/distributed/information_code.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <functional>

#include "graph/linear_patterns.hpp"
#include "graph/small_teams.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {
namespace {

std::string written(const Eigen::MatrixXd& a, Eigen::Index block) {
  WireWriter out;
  write_information(out, BlockInformation(a, block));
  return out.take();
}

Eigen::MatrixXd read_back(const Eigen::MatrixXd& a, Eigen::Index block) {
  const std::string bytes = written(a, block);
  WireReader in(bytes);
  const BlockInformation read = read_information(in, a.rows() / block, block);
  EXPECT_TRUE(in.good() && in.empty());
  return read.dense();
}

/// What elimination leaves of a long chain, without a gauge, on some of its poses.
template <class Pose>
Eigen::MatrixXd chain_on(const std::vector<std::size_t>& kept, std::size_t count) {
  auto graph = test::draw_team<Pose>(3, 1, count, 1).graph;
  NormalEquations<Pose> equations(graph, {std::vector<bool>(count, false), {}});
  equations.linearise(graph);
  equations.damp(0);
  const Eigen::MatrixXd h = test::dense(equations.matrix());
  std::vector<Eigen::Index> k, e;
  for (std::size_t p = 0; p < count; ++p) {
    const auto block = static_cast<std::size_t>(equations.blocks().poses[p]);
    const bool keep = std::find(kept.begin(), kept.end(), p) != kept.end();
    for (Eigen::Index d = 0; d < Pose::kDof; ++d)
      (keep ? k : e).push_back(static_cast<Eigen::Index>(equations.matrix().offset(block)) + d);
  }
  const Eigen::MatrixXd h_ek = h(e, k);
  const Eigen::MatrixXd reduced = h(k, k) - h_ek.transpose() * h(e, e).ldlt().solve(h_ek);
  return (reduced + reduced.transpose()) / 2;
}

template <class Pose>
class InformationCode : public testing::Test {};
TYPED_TEST_SUITE(InformationCode, test::PoseTypes);

TYPED_TEST(InformationCode, KeepsEntriesAndWeakDirections) {
  for (const auto& kept : std::vector<std::vector<std::size_t>>{{0, 59}, {0, 1, 2, 40, 41, 59}}) {
    const Eigen::MatrixXd a = chain_on<TypeParam>(kept, 60);
    const Eigen::MatrixXd b = read_back(a, TypeParam::kDof);
    ASSERT_EQ(b.rows(), a.rows());
    for (Eigen::Index r = 0; r < a.rows(); ++r)
      for (Eigen::Index c = 0; c < a.cols(); ++c)
        EXPECT_NEAR(b(r, c), a(r, c), 1e-6 * std::sqrt(a(r, r) * a(c, c))) << r << " " << c;
    const Eigen::VectorXd before = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues();
    const Eigen::VectorXd after = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(b).eigenvalues();
    const double strongest = before.maxCoeff();
    // The motion of all poses together costs nothing, and hardly anything after rounding.
    for (Eigen::Index k = 0; k < TypeParam::kDof; ++k) {
      EXPECT_LT(std::abs(before[k]), 1e-9 * strongest);
      EXPECT_LT(std::abs(after[k]), 1e-9 * strongest);
    }
    for (Eigen::Index k = TypeParam::kDof; k < before.size(); ++k)
      EXPECT_NEAR(after[k], before[k], 1e-3 * before[k]) << k;
    if (kept.size() > 2) {
      EXPECT_LT(before[TypeParam::kDof], 1e-3 * strongest) << "no weak direction";
    }
  }
}

TYPED_TEST(InformationCode, IsSemidefiniteWhenRead) {
  test::Drawing<TypeParam> draw(5);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd half(4 * TypeParam::kDof, TypeParam::kDof + 2);  // of low rank
    for (double& x : half.reshaped()) x = draw.rng.normal(0, 3);
    const Eigen::MatrixXd b = read_back(half * half.transpose(), TypeParam::kDof);
    const auto eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(b).eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
  }
}

TEST(InformationCodeBytes, ABlockOfZerosCostsABit) {
  constexpr Eigen::Index kBlocks = 10, kBlock = 3;
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Identity(kBlocks * kBlock, kBlocks * kBlock);
  // A byte for the form, a scale of four bytes per row, a bit per pair of blocks, three bytes per entry on or
  // below the diagonal.
  EXPECT_EQ(written(ones, kBlock).size(), 1 + 30u * 4 + 7 + 3 * 10 * 6);
  Eigen::MatrixXd tied = ones;
  tied.block(27, 0, 3, 3).setConstant(0.1);
  tied.block(0, 27, 3, 3).setConstant(0.1);
  EXPECT_EQ(written(tied, kBlock).size(), written(ones, kBlock).size() + 3 * 9);
  EXPECT_EQ(read_back(tied, kBlock).block(3, 0, 3, 3).norm(), 0);
}

TEST(InformationCodeBytes, ZeroAndNothingAreRead) {
  EXPECT_EQ(read_back(Eigen::MatrixXd::Zero(6, 6), 3).norm(), 0);
  EXPECT_EQ(read_back(Eigen::MatrixXd(0, 0), 3).size(), 0);
}

TEST(InformationCodeBytes, RefusesWhatIsTooShort) {
  const std::string bytes = written(Eigen::MatrixXd::Identity(9, 9), 3);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    WireReader in(std::string_view(bytes).substr(0, size));
    read_information(in, 3, 3);
    EXPECT_FALSE(in.good()) << size;
  }
}

// ---- what a liar's bytes cost ----

/// Bytes of a factor with blocks at some places, all entries the same.
std::string factor_bytes(std::uint32_t blocks, std::uint32_t block,
                         const std::function<bool(std::uint32_t, std::uint32_t)>& is_there) {
  WireWriter out;
  out.byte(0);
  for (std::uint32_t k = 0; k < blocks * block; ++k) out.f32(1);
  std::string bits((blocks * (blocks + 1) / 2 + 7) / 8, '\0'), entries;
  std::size_t place = 0;
  for (std::uint32_t j = 0; j < blocks; ++j)
    for (std::uint32_t i = j; i < blocks; ++i, ++place) {
      if (!is_there(i, j)) continue;
      bits[place / 8] = static_cast<char>(bits[place / 8] | 1 << (place % 8));
      entries += std::string(3 * (i == j ? block * (block + 1) / 2 : block * block), '\1');
    }
  return out.take() + bits + entries;
}

TEST(InformationCodeBytes, BlocksThatAreNotThereTakeNoMemory) {
  const std::string bytes = factor_bytes(1024, 6, [](auto, auto) { return false; });
  WireReader in(bytes);
  const BlockInformation read = read_information(in, 1024, 6);
  EXPECT_TRUE(in.good() && in.empty());
  EXPECT_TRUE(read.places().empty());
  EXPECT_TRUE(read.matrix().places().empty());
}

/// One full column would make all pairs of rows meet.
TEST(InformationCodeBytes, AFactorWhoseProductHasManyMoreBlocksIsRefused) {
  const auto column = [](std::uint32_t i, std::uint32_t j) { return i == j || j == 0; };
  for (const std::uint32_t blocks : {30u, 1000u}) {
    const std::string bytes = factor_bytes(blocks, 6, column);
    WireReader in(bytes);
    const BlockInformation read = read_information(in, blocks, 6);
    EXPECT_EQ(in.good(), blocks == 30);
    EXPECT_EQ(read.places().size(), 2 * blocks - 1);
  }
}

TEST(InformationCodeBytes, MoreBlocksThanThereAreBytesAreRefusedBeforeTheyAreRead) {
  std::string bytes = factor_bytes(100, 6, [](auto, auto) { return true; });
  bytes.pop_back();
  WireReader in(bytes);
  EXPECT_TRUE(read_information(in, 100, 6).places().empty());
  EXPECT_FALSE(in.good());
}

/// Rounding leaves the factor of such a matrix with blocks that only its own product fills.
TEST(InformationCodeBytes, WhatIsWrittenIsNeverRefused) {
  constexpr Eigen::Index kBlocks = 60, kBlock = 3, kRows = kBlocks * kBlock;
  Eigen::MatrixXd star = Eigen::MatrixXd::Identity(kRows, kRows);
  star.leftCols(kBlock).setConstant(1e-5);
  star.topRows(kBlock).setConstant(1e-5);
  star.topLeftCorner(kBlock, kBlock).setIdentity();
  EXPECT_LT((read_back(star, kBlock) - star).norm(), 1e-6);
}

}  // namespace
}  // namespace radioslam
