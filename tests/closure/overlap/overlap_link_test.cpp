#include <gtest/gtest.h>

#include "closure/overlap/overlap_worlds.hpp"

namespace radioslam {
namespace {

template <class Pose>
class OverlapLinkOf : public testing::Test {};
TYPED_TEST_SUITE(OverlapLinkOf, test::PoseTypes);

/// Covariance of T_i^-1 T_j by step-by-step propagation; i <= j.
template <class Pose>
typename Pose::Jacobian carried(const KeyframeOdometry<Pose>& chain, std::size_t i, std::size_t j) {
  typename Pose::Jacobian covariance = Pose::Jacobian::Zero();
  for (std::size_t k = i; k < j; ++k) {
    const typename Pose::Jacobian ad = (chain.poses[k + 1].inverse() * chain.poses[k]).adjoint();
    covariance = ad * covariance * ad.transpose() + chain.cov_steps[k];
  }
  return covariance;
}

TYPED_TEST(OverlapLinkOf, PrefixSumsEqualCarryingTheCovarianceAlong) {
  for (const double origin_m : {0.0, 1e6}) {
    test::WorldSize size;
    size.origin_m = origin_m;
    const auto world = test::draw_world<TypeParam>(3, size);
    const LinkCovariance<TypeParam> source(world.chains, world.links);
    for (std::size_t i = 0; i < size.poses; i += 7)
      for (std::size_t j = i; j < size.poses; j += 9) {
        const auto expected = carried(world.chains[0], i, j);
        // Coordinates of 1e6 m have a resolution of 1e-10 m, and so have the lever arms.
        EXPECT_LT((source.poses(0).odometry(i, j) - expected).norm(),
                  (origin_m > 0 ? 1e-7 : 1e-10) * (1e-3 + expected.norm()));
        const typename TypeParam::Jacobian ad =
            (world.chains[0].poses[i].inverse() * world.chains[0].poses[j]).adjoint();
        EXPECT_LT((source.poses(0).odometry(j, i) - ad * expected * ad.transpose()).norm(),
                  1e-6 * (1e-3 + expected.norm()));
      }
  }
}

/// Composition in right perturbations, rotated into the common frame's axes.
TYPED_TEST(OverlapLinkOf, RelativePlaceEqualsTheCompositionOverTheLink) {
  using Jacobian = typename TypeParam::Jacobian;
  const auto world = test::draw_world<TypeParam>(4, {});
  const LinkCovariance<TypeParam> source(world.chains, world.links);
  const auto view = source.team().view(0, 1);
  const auto& a = world.chains[0].poses;
  const auto& b = world.chains[1].poses;
  for (std::size_t c = 0; c < world.links.size(); ++c) {
    auto link = world.links[c];
    if (link.robot_a == 1) {
      const Jacobian ad = link.T_a_b.adjoint();
      link = {0, link.pose_b, 1, link.pose_a, link.T_a_b.inverse(), ad * link.covariance * ad.transpose()};
    }
    for (std::size_t k = 0; k < a.size(); k += 31)
      for (std::size_t l = 0; l < b.size(); l += 29) {
        const TypeParam T_cb_l = b[link.pose_b].inverse() * b[l];
        const TypeParam T_k_l = a[k].inverse() * a[link.pose_a] * link.T_a_b * T_cb_l;
        const Jacobian after_ca = (link.T_a_b * T_cb_l).inverse().adjoint(),
                       after_c = T_cb_l.inverse().adjoint();
        const Jacobian right = after_ca * source.poses(0).odometry(k, link.pose_a) * after_ca.transpose() +
                               after_c * link.covariance * after_c.transpose() +
                               source.poses(1).odometry(link.pose_b, l);
        const auto place = view.relative(c, source.poses(0).records()[k], source.poses(1).records()[l]);
        EXPECT_LT((place.difference_m - a[k].rotate(T_k_l.translation())).norm(), 1e-9);
        const TypeParam turn = TypeParam(TypeParam::Point::Zero(), rotation_of(a[k])) *
                               TypeParam(TypeParam::Point::Zero(), rotation_of(T_k_l));
        const Jacobian ad = turn.adjoint();
        EXPECT_LT((place.covariance - ad * right * ad.transpose()).norm(), 1e-8 * right.norm());
      }
  }
}

}  // namespace
}  // namespace radioslam
