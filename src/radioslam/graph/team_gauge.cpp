#include "radioslam/graph/team_gauge.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

template <class Pose>
using Generators = Eigen::Matrix<double, Pose::kDim, Pose::kDof>;

/// Velocity of a position under the rigid motions: along the axes, and turning about the origin.
template <class Pose>
Generators<Pose> generators(const typename Pose::Point& p) {
  Generators<Pose> g;
  g.template leftCols<Pose::kDim>().setIdentity();
  if constexpr (Pose::kDim == 2)
    g.col(2) << -p.y(), p.x();
  else
    g.template rightCols<3>() = -skew(p);
  return g;
}

}  // namespace

template <class Pose>
std::vector<typename Marginals<Pose>::PointCovariance> position_covariances_in_team_gauge(
    const Marginals<Pose>& marginals, const std::vector<Pose>& poses, const std::vector<PoseId>& of,
    const std::vector<double>& weights) {
  constexpr int kDim = Pose::kDim, kDof = Pose::kDof;
  using Square = Eigen::Matrix<double, kDof, kDof>;
  RADIOSLAM_CHECK(of.size() == weights.size(), "every position has a weight");
  typename Pose::Point centre = Pose::Point::Zero();
  double sum = 0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    centre += weights[k] * poses[of[k].index()].translation();
    sum += weights[k];
  }
  RADIOSLAM_CHECK(sum > 0, "some position has a weight");
  centre /= sum;

  std::vector<Generators<Pose>> g;
  Square normal = Square::Zero();
  for (std::size_t k = 0; k < of.size(); ++k) {
    g.push_back(generators<Pose>(poses[of[k].index()].translation() - centre));
    normal += weights[k] * g[k].transpose() * g[k];
  }
  const Square inverse = pseudo_inverse(normal);

  // The motion that is removed, as functions of the poses; a position's error is R times a pose's
  // translation.
  std::vector<typename Marginals<Pose>::PoseColumns> motion(of.size(),
                                                            Marginals<Pose>::PoseColumns::Zero(kDof, kDof));
  const auto rotation = [&](std::size_t k) {
    return Eigen::Matrix<double, kDim, kDim>(poses[of[k].index()].rotation_matrix());
  };
  for (std::size_t k = 0; k < of.size(); ++k)
    motion[k].template topRows<kDim>() = rotation(k).transpose() * (weights[k] * g[k] * inverse);
  const auto with_motion = marginals.with_functions(of, motion);
  Square of_motion = Square::Zero();
  for (std::size_t k = 0; k < of.size(); ++k) of_motion += motion[k].transpose() * with_motion[k];

  std::vector<typename Marginals<Pose>::PointCovariance> result;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const auto R = rotation(k);
    const Eigen::Matrix<double, kDim, kDim> fixed =
        R * marginals.pose(of[k]).template topLeftCorner<kDim, kDim>() * R.transpose();
    const Eigen::Matrix<double, kDim, kDim> cross =
        R * with_motion[k].template topRows<kDim>() * g[k].transpose();
    result.push_back(fixed - cross - cross.transpose() + g[k] * of_motion * g[k].transpose());
  }
  return result;
}

#define RADIOSLAM_TEAM_GAUGE(Pose)                                                           \
  template std::vector<Marginals<Pose>::PointCovariance> position_covariances_in_team_gauge( \
      const Marginals<Pose>&, const std::vector<Pose>&, const std::vector<PoseId>&,          \
      const std::vector<double>&);
RADIOSLAM_TEAM_GAUGE(SE2)
RADIOSLAM_TEAM_GAUGE(SE3)
#undef RADIOSLAM_TEAM_GAUGE

}  // namespace radioslam
