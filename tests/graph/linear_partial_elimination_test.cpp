#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "graph/linear_patterns.hpp"
#include "radioslam/graph/linear/partial_elimination.hpp"

namespace radioslam {
namespace {

std::vector<Eigen::Index> scalars_of(const SymmetricBlockMatrix& matrix,
                                     const std::vector<std::size_t>& blocks) {
  std::vector<Eigen::Index> scalars;
  for (const std::size_t b : blocks)
    for (std::int32_t k = 0; k < matrix.pattern().sizes[b]; ++k)
      scalars.push_back(static_cast<Eigen::Index>(matrix.offset(b)) + k);
  return scalars;
}

class PartialEliminationOfRandom : public testing::TestWithParam<std::vector<std::size_t>> {
 protected:
  PartialEliminationOfRandom() {
    test::RandomPatternParams params;
    params.blocks = 12;
    params.extra_edges = 15;
    params.sizes = {2, 3, 6};
    matrix_.emplace(test::random_matrix(rng_, test::random_pattern(rng_, params)));
    dense_ = test::dense(*matrix_);
    b_ = Eigen::VectorXd::NullaryExpr(dense_.rows(), [&] { return rng_.normal(0, 1); });
  }
  Rng rng_{7};
  std::optional<SymmetricBlockMatrix> matrix_;
  Eigen::MatrixXd dense_;
  Eigen::VectorXd b_;
};

TEST_P(PartialEliminationOfRandom, LeavesTheInverseOfTheInversesBlock) {
  PartialElimination elimination(matrix_->pattern(), GetParam());
  ASSERT_EQ(elimination.factorize(*matrix_), Factorization::kDone);
  const auto kept = scalars_of(*matrix_, GetParam());
  const Eigen::MatrixXd inverse = dense_.inverse();
  const Eigen::MatrixXd expected = Eigen::MatrixXd(inverse(kept, kept)).inverse();
  ASSERT_EQ(elimination.reduced().rows(), expected.rows());
  EXPECT_LT((elimination.reduced() - expected).norm(), 1e-9 * dense_.norm());
}

TEST_P(PartialEliminationOfRandom, SolvesTheWholeSystem) {
  PartialElimination elimination(matrix_->pattern(), GetParam());
  ASSERT_EQ(elimination.factorize(*matrix_), Factorization::kDone);
  const Eigen::VectorXd x = dense_.ldlt().solve(b_);
  const auto kept = scalars_of(*matrix_, GetParam());
  Eigen::VectorXd solved(0);
  if (!kept.empty()) solved = elimination.reduced().ldlt().solve(elimination.reduce(b_));
  EXPECT_LT((solved - x(kept)).norm(), 1e-9 * x.norm());
  EXPECT_LT((elimination.expand(b_, x(kept)) - x).norm(), 1e-9 * x.norm());
  // b^T H^-1 b is what the eliminated ones and then the kept ones contribute.
  EXPECT_NEAR(elimination.eliminated_norm(b_) + elimination.reduce(b_).dot(solved), b_.dot(x),
              1e-9 * b_.dot(x));
}

INSTANTIATE_TEST_SUITE_P(Kept, PartialEliminationOfRandom,
                         testing::Values(std::vector<std::size_t>{}, std::vector<std::size_t>{5},
                                         std::vector<std::size_t>{9, 0, 4},
                                         std::vector<std::size_t>{11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0}));

TEST(PartialElimination, NeedsOnlyTheEliminatedPartToBeDefinite) {
  SymmetricBlockMatrix matrix(test::pattern_of({1, 1}, {{0, 1}}));
  matrix.diagonal(0)(0, 0) = 2;
  matrix.diagonal(1)(0, 0) = 0.5;
  matrix.lower(0)(0, 0) = -1;  // singular
  PartialElimination first(matrix.pattern(), {1});
  EXPECT_EQ(first.factorize(matrix), Factorization::kDone);
  EXPECT_NEAR(first.reduced()(0, 0), 0, 1e-15);
  matrix.diagonal(0)(0, 0) = -1;
  EXPECT_EQ(first.factorize(matrix), Factorization::kNotPositiveDefinite);
}

}  // namespace
}  // namespace radioslam
