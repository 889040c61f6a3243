// The dense kernels of one front against dense linear algebra, and against each other.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/graph/linear/front_elimination.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {
namespace {

struct Front {
  FrontShape shape;
  Eigen::MatrixXd matrix;            ///< (p + r) x (p + r), positive definite
  Eigen::MatrixXd covariance_below;  ///< r x r
};

/// What the kernels make of a front.
struct Worked {
  bool positive = false;
  Eigen::MatrixXd panel, update, covariance;
  Eigen::MatrixXd solved;  ///< of right-hand sides of ones
};

/// Numbers of right-hand sides solved at once differ from front to front.
Eigen::Index right_sides(const Front& front) {
  return static_cast<Eigen::Index>(1 + (front.shape.pivots + 3 * front.shape.below) % 50);
}

Eigen::MatrixXd random_positive(Rng& rng, Eigen::Index size) {
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return rng.uniform(-1, 1); });
  Eigen::MatrixXd matrix = root * root.transpose();
  matrix.diagonal().array() += 0.1 * static_cast<double>(size);
  return matrix;
}

Front random_front(Rng& rng, std::size_t pivots, std::size_t below) {
  const auto r = static_cast<Eigen::Index>(below);
  return {{pivots, below},
          random_positive(rng, static_cast<Eigen::Index>(pivots) + r),
          random_positive(rng, r) / (1 + static_cast<double>(r))};
}

void clear_above_diagonal(Eigen::Ref<Eigen::MatrixXd> matrix) {
  if (matrix.size() > 0) matrix.triangularView<Eigen::StrictlyUpper>().setZero();
}

Worked work(const FrontKernels& kernels, const Front& front) {
  const auto p = static_cast<Eigen::Index>(front.shape.pivots);
  const auto r = static_cast<Eigen::Index>(front.shape.below);
  Worked worked;
  worked.panel = front.matrix.leftCols(p);
  clear_above_diagonal(worked.panel.topRows(p));
  worked.update.setZero(r, r);
  worked.positive = kernels.eliminate(front.shape, worked.panel.data(), worked.update.data());
  worked.covariance.setZero(p + r, p);
  Eigen::VectorXd scratch(p * (p + r));
  kernels.invert(front.shape, worked.panel.data(), front.covariance_below.data(), worked.covariance.data(),
                 scratch.data());
  clear_above_diagonal(worked.panel.topRows(p));
  clear_above_diagonal(worked.update);
  const Eigen::MatrixXd below = Eigen::MatrixXd::Ones(right_sides(front), r);
  worked.solved.setOnes(right_sides(front), p);
  kernels.solve_back(front.shape, worked.panel.data(), static_cast<std::size_t>(right_sides(front)),
                     below.data(), worked.solved.data());
  return worked;
}

void expect_close(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const char* what) {
  if (b.size() == 0) return;
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), 1e-10 * (1 + b.cwiseAbs().maxCoeff())) << what;
}

void expect_front_agrees_with_dense(const Front& front, const Worked& worked) {
  const auto p = static_cast<Eigen::Index>(front.shape.pivots);
  const auto r = static_cast<Eigen::Index>(front.shape.below);
  const Eigen::MatrixXd pivots = front.matrix.topLeftCorner(p, p),
                        below = front.matrix.bottomLeftCorner(r, p);
  const Eigen::LLT<Eigen::MatrixXd> factor(pivots);
  const Eigen::MatrixXd L = factor.matrixL();
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(p, p));
  expect_close(worked.panel.topRows(p), L, "L_PP");
  const Eigen::VectorXd unsolved =
      Eigen::VectorXd::Ones(p) - worked.panel.bottomRows(r).colwise().sum().transpose();
  const Eigen::VectorXd solved = L.triangularView<Eigen::Lower>().transpose().solve(unsolved);
  expect_close(worked.solved, solved.transpose().replicate(right_sides(front), 1), "solved");
  if (r == 0) {
    expect_close(worked.covariance, inverse, "Z_PP");
    return;
  }
  const Eigen::MatrixXd L_RP = L.triangularView<Eigen::Lower>().solve(below.transpose()).transpose();
  expect_close(worked.panel.bottomRows(r), L_RP, "L_RP");
  Eigen::MatrixXd update = -L_RP * L_RP.transpose();
  clear_above_diagonal(update);
  expect_close(worked.update, update, "update");
  const Eigen::MatrixXd Y = below * inverse;
  const Eigen::MatrixXd Z_RP = -front.covariance_below * Y;
  expect_close(worked.covariance.bottomRows(r), Z_RP, "Z_RP");
  expect_close(worked.covariance.topRows(p), inverse - Y.transpose() * Z_RP, "Z_PP");
}

TEST(FrontKernels, AgreeWithDenseAndGiveTheSameBytesForEveryInstructionSet) {
  Rng rng(1);
  std::vector<std::pair<std::size_t, std::size_t>> shapes;
  for (std::size_t p = 1; p <= 20; ++p) {
    for (std::size_t r = 0; r <= 20; ++r) shapes.emplace_back(p, r);
  }
  shapes.insert(shapes.end(), {{96, 0}, {97, 96}, {102, 300}, {300, 17}, {290, 270}, {60, 259}});
  for (const auto& [p, r] : shapes) {
    SCOPED_TRACE(testing::Message() << p << " pivots, " << r << " below");
    const auto front = random_front(rng, p, r);
    const auto kernels = available_front_kernels();
    const auto first = work(kernels.front(), front);
    ASSERT_TRUE(first.positive);
    expect_front_agrees_with_dense(front, first);
    for (const auto& other : kernels) {
      const auto second = work(other, front);
      EXPECT_EQ(first.panel, second.panel) << other.instruction_set;
      EXPECT_EQ(first.update, second.update) << other.instruction_set;
      EXPECT_EQ(first.covariance, second.covariance) << other.instruction_set;
      EXPECT_EQ(first.solved, second.solved) << other.instruction_set;
    }
  }
}

/// The panel and update matrix of the kernels' steps, with zeros above the diagonals.
Worked eliminated_in_steps(const FrontKernels& kernels, const Front& front) {
  const auto p = static_cast<Eigen::Index>(front.shape.pivots);
  Worked worked;
  worked.panel = front.matrix.leftCols(p);
  clear_above_diagonal(worked.panel.topRows(p));
  worked.update.setZero(front.matrix.rows() - p, front.matrix.rows() - p);
  worked.positive = eliminate_front_in_steps(kernels, front.shape, worked.panel.data(), worked.update.data());
  clear_above_diagonal(worked.panel.topRows(p));
  clear_above_diagonal(worked.update);
  return worked;
}

TEST(FrontKernels, GiveTheSameBytesInStepsOnAnyNumberOfThreads) {
  Rng rng(3);
  const std::vector<std::pair<std::size_t, std::size_t>> shapes = {
      {1, 0}, {1, 1}, {5, 3}, {96, 0}, {97, 1}, {60, 259}, {193, 96}, {200, 500}, {500, 200}};
  for (const auto& [p, r] : shapes) {
    SCOPED_TRACE(testing::Message() << p << " pivots, " << r << " below");
    const auto front = random_front(rng, p, r);
    for (const auto& kernels : available_front_kernels()) {
      const auto whole = work(kernels, front);
      for (const std::size_t threads : {1U, 3U}) {
        set_thread_count(threads);
        const auto steps = eliminated_in_steps(kernels, front);
        EXPECT_TRUE(steps.positive);
        EXPECT_EQ(steps.panel, whole.panel) << kernels.instruction_set << ", threads " << threads;
        EXPECT_EQ(steps.update, whole.update) << kernels.instruction_set << ", threads " << threads;
      }
      set_thread_count(0);
    }
  }
}

TEST(FrontKernels, MultiplyPickedColumnsWithTheSameBytesForEveryInstructionSet) {
  Rng rng(5);
  for (const auto& [rows, picked, columns] :
       {std::array<Eigen::Index, 3>{1, 1, 1}, {7, 0, 3}, {30, 12, 5}, {400, 300, 49}, {193, 145, 7}}) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(rows, picked + 9, [&] { return rng.normal(); });
    const Eigen::MatrixXd b = Eigen::MatrixXd::NullaryExpr(picked, columns, [&] { return rng.normal(); });
    std::vector<std::uint32_t> which;
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(rows, columns);
    for (Eigen::Index k = 0; k < picked; ++k) {
      which.push_back(static_cast<std::uint32_t>(rng.below(static_cast<std::uint64_t>(picked) + 9)));
      expected += a.col(which.back()) * b.row(k);
    }
    std::vector<Eigen::MatrixXd> products;
    for (const auto& kernels : available_front_kernels()) {
      Eigen::MatrixXd& c = products.emplace_back(rows, columns);
      kernels.multiply({a.data(), static_cast<std::size_t>(rows), which.data(), which.size()},
                       static_cast<std::size_t>(columns), b.data(), c.data());
      expect_close(c, expected, kernels.instruction_set);
      EXPECT_EQ(c, products.front()) << kernels.instruction_set;
    }
  }
}

TEST(FrontKernels, RefuseAPivotInSteps) {
  Rng rng(4);
  for (Eigen::Index bad = 0; bad < 150; bad += 7) {
    auto front = random_front(rng, 150, 120);
    front.matrix(bad, bad) = -1;
    EXPECT_FALSE(eliminated_in_steps(front_kernels(), front).positive) << bad;
  }
}

TEST(FrontKernels, RefuseAPivotThatIsNotPositive) {
  Rng rng(2);
  for (const auto& kernels : available_front_kernels()) {
    for (Eigen::Index bad = 0; bad < 150; bad += 7) {
      auto front = random_front(rng, 150, 6);
      front.matrix(bad, bad) = -1;
      EXPECT_FALSE(work(kernels, front).positive) << bad;
    }
  }
}

}  // namespace
}  // namespace radioslam
