// Laws of positions' covariances in the gauge of the team.
#include "radioslam/graph/team_gauge.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "graph/random_graphs.hpp"
#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPoses = 12;

template <class Pose>
class TeamGauge : public testing::Test {
 protected:
  using Covariances = std::vector<typename Marginals<Pose>::PointCovariance>;

  void SetUp() override {
    graph = test::draw_graph<Pose>(5, kPoses, 0, test::Extras::kNone);
    for (auto& f : graph.relative_poses) f.information *= 1e4;
    for (std::size_t k = 0; k < kPoses; ++k) {
      all.push_back(PoseId(k));
      weights.push_back(1 + 0.3 * static_cast<double>(k % 4));
    }
  }
  Covariances with_fixed(std::size_t held) {
    graph.pose_fixed.assign(kPoses, false);
    graph.pose_fixed[held] = true;
    return position_covariances_in_team_gauge(*Marginals<Pose>::compute(graph), graph.poses, all, weights);
  }

  PoseGraph<Pose> graph;
  std::vector<PoseId> all;
  std::vector<double> weights;
};
TYPED_TEST_SUITE(TeamGauge, test::PoseTypes);

TYPED_TEST(TeamGauge, DoesNotDependOnThePoseThatHoldsTheFrame) {
  const auto first = this->with_fixed(0), middle = this->with_fixed(kPoses / 2);
  for (std::size_t k = 0; k < kPoses; ++k) {
    EXPECT_GT(first[k].trace(), 0);
    EXPECT_LT((first[k] - middle[k]).norm(), 1e-8 * first[k].norm()) << k;
  }
}

/// Errors are drawn from the covariance of the whole chain, and aligned as a trajectory is evaluated.
TYPED_TEST(TeamGauge, IsTheSpreadOfWhatAnAlignmentLeaves) {
  using Pose = TypeParam;
  constexpr int kDim = Pose::kDim, kDof = Pose::kDof, kDraws = 4000;
  this->graph.relative_poses.resize(kPoses - 1);  // the chain alone
  const auto stated = this->with_fixed(0);
  const auto& poses = this->graph.poses;
  Eigen::Matrix<double, kDim, Eigen::Dynamic> truth(kDim, kPoses), drawn = truth;
  for (std::size_t k = 0; k < kPoses; ++k) truth.col(static_cast<Eigen::Index>(k)) = poses[k].translation();
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(this->weights.data(), kPoses);
  test::Drawing<Pose> draw(6);
  std::vector<double> squares(kPoses, 0);
  for (int n = 0; n < kDraws; ++n) {
    Pose pose = poses[0];
    for (std::size_t k = 0; k < kPoses; ++k) {
      drawn.col(static_cast<Eigen::Index>(k)) = pose.translation();
      if (k + 1 == kPoses) break;
      const auto& factor = this->graph.relative_poses[k];
      const typename Pose::Jacobian root = factor.information.llt().matrixU();
      const typename Pose::Tangent error = root.inverse() * draw.template normals<kDof>(1);
      pose = pose * poses[k].inverse() * poses[k + 1] * Pose::exp(error);
    }
    const Pose T = align_points(drawn, truth, weights);
    for (std::size_t k = 0; k < kPoses; ++k) {
      const auto c = static_cast<Eigen::Index>(k);
      squares[k] += (T * typename Pose::Point(drawn.col(c)) - truth.col(c)).squaredNorm() / kDraws;
    }
  }
  for (std::size_t k = 0; k < kPoses; ++k) EXPECT_NEAR(squares[k] / stated[k].trace(), 1, 0.1) << k;
}

TYPED_TEST(TeamGauge, RemovesNoTurnThatPositionsLeaveOpen) {
  this->all.resize(1);
  this->weights.resize(1);
  EXPECT_LT(this->with_fixed(3)[0].norm(), 1e-12) << "a single position is always where it should be";
}

}  // namespace
}  // namespace radioslam
