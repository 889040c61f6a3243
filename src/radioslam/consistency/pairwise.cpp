#include "radioslam/consistency/pairwise.hpp"

#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kRowGrain = 8;  // rows of pairs per task

template <class Pose>
typename Pose::Jacobian carried(const typename Pose::Jacobian& jacobian,
                                const typename Pose::Jacobian& covariance) {
  return congruence(jacobian, covariance);
}

/// xi.
template <class Pose>
typename Pose::Tangent loop_error(const Pose& z_i, const Pose& f, const Pose& z_j, const Pose& e) {
  return (z_i * f * z_j.inverse() * e.inverse()).log();
}

/// xi^T xi.
template <class Pose>
double pair_squared_error(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                          const RelativePoseMatch<Pose>& i, const RelativePoseMatch<Pose>& j) {
  return loop_error(i.T_a_b, chain_b.increment(i.pose_b, j.pose_b), j.T_a_b,
                    chain_a.increment(i.pose_a, j.pose_a))
      .squaredNorm();
}

template <class Pose>
double largest_statistic(const PairwiseParams& params) {
  return params.max_norm ? *params.max_norm * *params.max_norm
                         : chi_squared_quantile(params.confidence, Pose::kDof);
}

template <class Pose>
void check_matches(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                   const std::vector<RelativePoseMatch<Pose>>& matches) {
  for (const auto& match : matches)
    RADIOSLAM_CHECK(match.pose_a < chain_a.size() && match.pose_b < chain_b.size(),
                    "a match is between poses of the chains");
}

}  // namespace

template <class Pose>
LoopJacobians<Pose> loop_jacobians(const Pose& f, const Pose& z_j, const Pose& e) {
  const Pose e_z_j = e * z_j;
  const typename Pose::Jacobian ad = e_z_j.adjoint();
  return {(e_z_j * f.inverse()).adjoint(), ad, -ad, -e.adjoint()};
}

template <class Pose>
double loop_statistic(const UncertainPose<Pose>& z_i, const UncertainPose<Pose>& f,
                      const UncertainPose<Pose>& z_j, const UncertainPose<Pose>& e) {
  using Jacobian = typename Pose::Jacobian;
  const auto by = loop_jacobians(f.pose, z_j.pose, e.pose);
  // F and Z_j enter by the same Jacobian but for the sign.
  const Jacobian sigma = carried<Pose>(by.z_i, z_i.covariance) +
                         carried<Pose>(by.f, f.covariance + z_j.covariance) +
                         carried<Pose>(by.e, e.covariance);
  const Cholesky<Jacobian> cholesky(sigma);
  if (!cholesky.succeeded()) return std::numeric_limits<double>::infinity();
  return cholesky.whitened(loop_error(z_i.pose, f.pose, z_j.pose, e.pose)).squaredNorm();
}

template <class Pose>
double pair_statistic(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                      const RelativePoseMatch<Pose>& i, const RelativePoseMatch<Pose>& j) {
  return loop_statistic<Pose>({i.T_a_b, i.covariance}, chain_b.between(i.pose_b, j.pose_b),
                              {j.T_a_b, j.covariance}, chain_a.between(i.pose_a, j.pose_a));
}

template <class Pose>
PairwiseConsistency pairwise_consistency(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                                         const std::vector<RelativePoseMatch<Pose>>& matches,
                                         const PairwiseParams& params) {
  check_matches(chain_a, chain_b, matches);
  const std::size_t n = matches.size();
  PairwiseConsistency result{UndirectedGraph(n), largest_statistic<Pose>(params), {}};
  const auto statistic = params.max_norm ? pair_squared_error<Pose> : pair_statistic<Pose>;
  result.statistics.resize(n < 2 ? 0 : n * (n - 1) / 2);
  parallel_for(n, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = 0; j < i; ++j)
        result.statistics[i * (i - 1) / 2 + j] =
            static_cast<float>(statistic(chain_a, chain_b, matches[i], matches[j]));
  });
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (result.statistic(i, j) <= result.gate) result.graph.connect(i, j);
  return result;
}

// NOLINTBEGIN(bugprone-macro-parentheses): Pose is a type.
#define RADIOSLAM_INSTANTIATE(Pose)                                                                 \
  template LoopJacobians<Pose> loop_jacobians(const Pose&, const Pose&, const Pose&);               \
  template double loop_statistic(const UncertainPose<Pose>&, const UncertainPose<Pose>&,            \
                                 const UncertainPose<Pose>&, const UncertainPose<Pose>&);           \
  template double pair_statistic(const PoseChain<Pose>&, const PoseChain<Pose>&,                    \
                                 const RelativePoseMatch<Pose>&, const RelativePoseMatch<Pose>&);   \
  template PairwiseConsistency pairwise_consistency(const PoseChain<Pose>&, const PoseChain<Pose>&, \
                                                    const std::vector<RelativePoseMatch<Pose>>&,    \
                                                    const PairwiseParams&)
// NOLINTEND(bugprone-macro-parentheses)
RADIOSLAM_INSTANTIATE(SE2);
RADIOSLAM_INSTANTIATE(SE3);
#undef RADIOSLAM_INSTANTIATE

}  // namespace radioslam
