// Block Cholesky and selected inversion against dense linear algebra.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "graph/linear_patterns.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"

namespace radioslam {

/// What a parameterised test is called in a list of tests.
static void PrintTo(Ordering ordering, std::ostream* out) {
  const char* const names[] = {"best", "AMD", "METIS", "natural"};
  *out << names[static_cast<std::size_t>(ordering)];
}

namespace {

using test::dense;
using test::random_matrix;
using test::random_pattern;
using test::RandomPatternParams;

Eigen::VectorXd random_vector(Rng& rng, std::size_t rows) {
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(rows), [&] { return rng.normal(); });
}

void expect_near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const char* what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), 1e-9 * (1 + b.cwiseAbs().maxCoeff())) << what;
}

void expect_inverse_blocks(const SymmetricBlockMatrix& matrix, const SelectedInverse& inverse,
                           const Eigen::MatrixXd& expected) {
  const auto& sizes = matrix.pattern().sizes;
  const auto block_of = [&](std::size_t i, std::size_t j) {
    return expected.block(static_cast<Eigen::Index>(matrix.offset(i)),
                          static_cast<Eigen::Index>(matrix.offset(j)), sizes[i], sizes[j]);
  };
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    expect_near(inverse.diagonal(i), block_of(i, i), "diagonal");
    for (std::size_t j = 0; j < sizes.size(); ++j) {
      if (const auto block = inverse.block(i, j)) expect_near(*block, block_of(i, j), "block");
    }
  }
  for (const auto& [row, column] : matrix.pattern().lower) {
    EXPECT_TRUE(inverse.block(static_cast<std::size_t>(row), static_cast<std::size_t>(column)));
  }
}

/// Every block of the inverse, put together from parts.
void expect_inverse_of_parts(const SymmetricBlockMatrix& matrix, const PartitionedInverse& parts,
                             const Eigen::MatrixXd& inverse) {
  const auto& sizes = matrix.pattern().sizes;
  for (std::size_t i = 0; i < sizes.size(); i += 1 + sizes.size() / 40)
    for (std::size_t j = 0; j < sizes.size(); j += 1 + sizes.size() / 30) {
      const auto &of_i = parts.boundary(parts.part_of(i)), &of_j = parts.boundary(parts.part_of(j));
      Eigen::MatrixXd between(of_i.size(), of_j.size());
      for (std::size_t k = 0; k < of_i.size(); ++k)
        for (std::size_t l = 0; l < of_j.size(); ++l)
          between(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) =
              parts.separators()(of_i[k], of_j[l]);
      Eigen::MatrixXd block = parts.by_boundary(i).transpose() * between * parts.by_boundary(j);
      if (parts.part_of(i) == parts.part_of(j) && !parts.is_separator(i) && !parts.is_separator(j))
        block += parts.local_rows({i}).middleCols(parts.local_column(j), sizes[j]);
      expect_near(block,
                  inverse.block(static_cast<Eigen::Index>(matrix.offset(i)),
                                static_cast<Eigen::Index>(matrix.offset(j)), sizes[i], sizes[j]),
                  "block by parts");
    }
}

/// Everything the class offers, against the dense answer.
void expect_agrees_with_dense(const SymmetricBlockMatrix& matrix, BlockCholesky& cholesky, Rng& rng) {
  ASSERT_EQ(cholesky.factorize(matrix), Factorization::kDone);
  const Eigen::MatrixXd H = dense(matrix);
  const Eigen::LLT<Eigen::MatrixXd> reference(H);
  ASSERT_EQ(reference.info(), Eigen::Success);
  const Eigen::MatrixXd inverse = reference.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()));

  const auto b = random_vector(rng, matrix.rows());
  expect_near(cholesky.solve(b), reference.solve(b), "solve");
  const Eigen::MatrixXd L = reference.matrixL();
  EXPECT_NEAR(cholesky.log_determinant(), 2 * L.diagonal().array().log().sum(),
              1e-9 * (1 + static_cast<double>(H.rows())));
  for (std::size_t j = 0; j < matrix.pattern().blocks(); j += 7) {
    expect_near(cholesky.inverse_columns(j),
                inverse.middleCols(static_cast<Eigen::Index>(matrix.offset(j)), matrix.pattern().sizes[j]),
                "inverse columns");
  }
  std::vector<std::size_t> several;
  for (std::size_t j = 0; j < matrix.pattern().blocks(); j += 3) several.push_back(j);
  const Eigen::MatrixXd rows = cholesky.inverse_rows(several);
  Eigen::Index row = 0;
  for (const std::size_t j : several) {
    const Eigen::Index size = matrix.pattern().sizes[j];
    expect_near(rows.middleRows(row, size),
                inverse.middleRows(static_cast<Eigen::Index>(matrix.offset(j)), size), "inverse rows");
    row += size;
  }
  EXPECT_EQ(row, rows.rows());
  std::reverse(several.begin(), several.end());
  const Eigen::MatrixXd between = cholesky.inverse_between(several);
  Eigen::Index first = 0;
  for (const std::size_t i : several) {
    Eigen::Index second = 0;
    for (const std::size_t j : several) {
      const Eigen::Index size_i = matrix.pattern().sizes[i], size_j = matrix.pattern().sizes[j];
      expect_near(between.block(first, second, size_i, size_j),
                  inverse.block(static_cast<Eigen::Index>(matrix.offset(i)),
                                static_cast<Eigen::Index>(matrix.offset(j)), size_i, size_j),
                  "inverse between blocks");
      second += size_j;
    }
    first += matrix.pattern().sizes[i];
  }
  EXPECT_EQ(first, between.rows());
  for (const std::size_t part_scalars : {std::size_t{0}, std::size_t{1}, 1 + matrix.rows() / 8})
    expect_inverse_of_parts(matrix, cholesky.partitioned_inverse(part_scalars), inverse);
  expect_inverse_blocks(matrix, cholesky.selected_inverse(), inverse);
}

void expect_agrees_with_dense(const BlockPattern& pattern, const BlockCholeskyOptions& options, Rng& rng) {
  BlockCholesky cholesky(pattern, options);
  expect_agrees_with_dense(random_matrix(rng, pattern), cholesky, rng);
}

BlockPattern full_pattern(std::size_t blocks, std::int32_t size) {
  BlockPattern pattern{std::vector<std::int32_t>(blocks, size), {}};
  for (std::int32_t column = 0; column < static_cast<std::int32_t>(blocks); ++column) {
    for (std::int32_t row = column + 1; row < static_cast<std::int32_t>(blocks); ++row) {
      pattern.lower.push_back({row, column});
    }
  }
  return pattern;
}

class BlockCholeskyOrderings : public testing::TestWithParam<Ordering> {};
INSTANTIATE_TEST_SUITE_P(All, BlockCholeskyOrderings,
                         testing::Values(Ordering::kBest, Ordering::kAmd, Ordering::kMetis,
                                         Ordering::kNatural));

TEST_P(BlockCholeskyOrderings, AgreeWithDenseOnMixedBlockSizes) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Rng rng(seed);
    const auto pattern =
        random_pattern(rng, {.blocks = 5 + 3 * seed, .extra_edges = 2 * seed, .sizes = {1, 2, 3, 6}});
    SCOPED_TRACE(seed);
    expect_agrees_with_dense(pattern, {.ordering = GetParam(), .last = {}}, rng);
  }
}

TEST_P(BlockCholeskyOrderings, AgreeWithDenseOnManyComponents) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Rng rng(seed);
    const auto pattern =
        random_pattern(rng, {.blocks = 60, .extra_edges = 10, .sizes = {2, 3}, .chain_ratio = 0.4});
    SCOPED_TRACE(seed);
    expect_agrees_with_dense(pattern, {.ordering = GetParam(), .last = {}}, rng);
  }
}

TEST_P(BlockCholeskyOrderings, AgreeWithDenseWithBlocksForcedLast) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Rng rng(seed);
    const auto pattern = random_pattern(rng, {.blocks = 50, .extra_edges = 30, .sizes = {2, 6}});
    SCOPED_TRACE(seed);
    expect_agrees_with_dense(pattern, {.ordering = GetParam(), .last = {3, 40, 17}}, rng);
  }
}

TEST_P(BlockCholeskyOrderings, AgreeWithDenseOnAFullMatrix) {
  Rng rng(5);
  expect_agrees_with_dense(full_pattern(40, 6), {.ordering = GetParam(), .last = {}}, rng);
}

TEST_P(BlockCholeskyOrderings, HandleNoBlocksAndOneBlock) {
  Rng rng(1);
  const BlockCholeskyOptions options{.ordering = GetParam(), .last = {}};
  expect_agrees_with_dense({{3}, {}}, options, rng);
  expect_agrees_with_dense({{1, 2, 6}, {}}, options, rng);
  BlockCholesky nothing(BlockPattern{}, options);
  EXPECT_EQ(nothing.factorize(SymmetricBlockMatrix(BlockPattern{})), Factorization::kDone);
  EXPECT_EQ(nothing.solve({}).size(), 0);
  EXPECT_EQ(nothing.log_determinant(), 0);
  nothing.selected_inverse();
}

TEST(BlockCholesky, FactorsLargeFronts) {
  Rng rng(9);
  expect_agrees_with_dense(random_pattern(rng, {.blocks = 150, .extra_edges = 1500, .sizes = {6}}), {}, rng);
  expect_agrees_with_dense(random_pattern(rng, {.blocks = 300, .extra_edges = 900, .sizes = {1, 2, 3}}), {},
                           rng);
}

TEST(BlockCholesky, ABlockTiedToAllOthersGoesLast) {
  Rng rng(2);
  std::set<std::pair<int, int>> edges;
  for (int i = 1; i < 80; ++i) {
    edges.emplace(0, i);
    if (i > 1) edges.emplace(i - 1, i);
  }
  const auto pattern = test::pattern_of(std::vector<std::int32_t>(80, 3), edges);
  const BlockCholesky first(pattern, {.ordering = Ordering::kNatural, .last = {}});
  BlockCholesky last(pattern, {.ordering = Ordering::kNatural, .last = {0}});
  EXPECT_LT(last.factor_flops(), first.factor_flops() / 10);
  expect_agrees_with_dense(random_matrix(rng, pattern), last, rng);
}

/// Blocks on a cube, each connected to its neighbours along the axes.
BlockPattern lattice_pattern(int side, std::int32_t size) {
  std::set<std::pair<int, int>> edges;
  const int blocks = side * side * side;
  for (int i = 0; i < blocks; ++i) {
    for (const int step : {1, side, side * side}) {
      if ((i / step) % side + 1 < side) edges.emplace(i, i + step);
    }
  }
  return test::pattern_of(std::vector<std::int32_t>(static_cast<std::size_t>(blocks), size), edges);
}

TEST(BlockCholesky, BestIsTheCheaperOrder) {
  const auto flops = [](const BlockPattern& pattern, Ordering ordering) {
    return BlockCholesky(pattern, {ordering, {}}).factor_flops();
  };
  const auto lattice = lattice_pattern(9, 6);
  EXPECT_EQ(flops(lattice, Ordering::kBest),
            std::min(flops(lattice, Ordering::kAmd), flops(lattice, Ordering::kMetis)));
  EXPECT_LT(flops(lattice, Ordering::kBest), flops(lattice, Ordering::kNatural) / 2);
  Rng rng(1);
  const auto sparse = random_pattern(rng, {.blocks = 400, .extra_edges = 40, .sizes = {3, 6}});
  EXPECT_LE(flops(sparse, Ordering::kBest), flops(sparse, Ordering::kAmd));
  EXPECT_LT(flops(sparse, Ordering::kBest), flops(sparse, Ordering::kNatural));
}

TEST(BlockCholesky, FactorsAgainWithOtherValues) {
  Rng rng(3);
  const auto pattern = random_pattern(rng, {.blocks = 60, .extra_edges = 40, .sizes = {3, 6}});
  BlockCholesky cholesky(pattern);
  for (int round = 0; round < 3; ++round) {
    expect_agrees_with_dense(random_matrix(rng, pattern), cholesky, rng);
  }
}

TEST(BlockCholesky, AnInverseOutlivesItsFactor) {
  Rng rng(4);
  const auto pattern = random_pattern(rng, {.blocks = 30, .extra_edges = 20, .sizes = {3}});
  const auto matrix = random_matrix(rng, pattern);
  BlockCholesky cholesky(pattern);
  ASSERT_EQ(cholesky.factorize(matrix), Factorization::kDone);
  const auto inverse = cholesky.selected_inverse();
  ASSERT_EQ(cholesky.factorize(random_matrix(rng, pattern)), Factorization::kDone);
  const auto another = cholesky.selected_inverse();
  cholesky = BlockCholesky(BlockPattern{});
  expect_inverse_blocks(matrix, inverse, dense(matrix).inverse());
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const auto pattern = random_pattern(rng, {.blocks = 40, .extra_edges = 30, .sizes = {1, 3, 6}});
    auto matrix = random_matrix(rng, pattern);
    BlockCholesky cholesky(pattern);
    const auto i = rng.below(pattern.blocks());
    const double good = matrix.diagonal(i)(0, 0);
    for (const double bad : {-good, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
      matrix.diagonal(i)(0, 0) = bad;
      EXPECT_EQ(cholesky.factorize(matrix), Factorization::kNotPositiveDefinite) << bad;
    }
    matrix.diagonal(i)(0, 0) = good;
    EXPECT_EQ(cholesky.factorize(matrix), Factorization::kDone);
  }
}

TEST(BlockCholeskyDeathTest, AFailedFactorCannotBeUsed) {
  const BlockPattern pattern{{1}, {}};
  SymmetricBlockMatrix matrix(pattern);
  matrix.diagonal(0)(0, 0) = -1;
  BlockCholesky cholesky(pattern);
  EXPECT_EQ(cholesky.factorize(matrix), Factorization::kNotPositiveDefinite);
  EXPECT_DEATH(cholesky.solve(Eigen::VectorXd::Ones(1)), "no factor");
  EXPECT_DEATH(cholesky.log_determinant(), "no factor");
  EXPECT_DEATH(cholesky.selected_inverse(), "no factor");
}

TEST(BlockCholeskyDeathTest, AnotherPatternIsRefused) {
  BlockCholesky cholesky(BlockPattern{{1, 1}, {{1, 0}}});
  EXPECT_DEATH(cholesky.factorize(SymmetricBlockMatrix(BlockPattern{{1, 1}, {}})), "another pattern");
  EXPECT_DEATH(BlockCholesky(BlockPattern{{1, 1}, {}}, {.ordering = Ordering::kAmd, .last = {1, 1}}),
               "twice");
}

TEST(BlockCholesky, GivesTheSameBytesTwice) {
  Rng rng(6);
  const auto pattern = random_pattern(rng, {.blocks = 200, .extra_edges = 150, .sizes = {3, 6}});
  const auto matrix = random_matrix(rng, pattern);
  const auto b = random_vector(rng, matrix.rows());
  BlockCholesky one(pattern), two(pattern);
  ASSERT_EQ(one.factorize(matrix), Factorization::kDone);
  ASSERT_EQ(two.factorize(matrix), Factorization::kDone);
  ASSERT_EQ(two.factorize(matrix), Factorization::kDone);
  EXPECT_EQ(one.solve(b), two.solve(b));
  const auto inverse_one = one.selected_inverse(), inverse_two = two.selected_inverse();
  for (std::size_t i = 0; i < pattern.blocks(); ++i) {
    EXPECT_EQ(inverse_one.diagonal(i), inverse_two.diagonal(i));
  }
}

}  // namespace
}  // namespace radioslam
