#include "radioslam/graph/chordal.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "radioslam/graph/pose_network_solver.hpp"
#include "radioslam/graph/relative_pose_network.hpp"

namespace radioslam {
namespace {

template <class Pose>
using Matrices = std::vector<typename PoseNetworkSolver<Pose>::Matrix>;

Eigen::Matrix2d nearest_rotation(const Eigen::Matrix2d& m) {
  return SE2({0, 0}, std::atan2(m(1, 0) - m(0, 1), m.trace())).rotation_matrix();
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

SE2 make_pose(const Eigen::Vector2d& t, const Eigen::Matrix2d& r) {
  return {t, std::atan2(r(1, 0), r(0, 0))};
}
SE3 make_pose(const Eigen::Vector3d& t, const Eigen::Matrix3d& r) { return {t, Eigen::Quaterniond(r)}; }

/// The poses that hold the others: the roots of the breadth-first trees.
template <class Pose>
std::vector<bool> held_poses(const PoseGraph<Pose>& graph) {
  std::vector<bool> held(graph.poses.size(), false);
  for (const auto& step : breadth_first_tree(graph))
    if (step.pose == step.from) held[step.pose] = true;
  return held;
}

/// The transposed rotations, X_j = R_ij^T X_i, on matrices that need not be rotations.
template <class Pose>
std::optional<Matrices<Pose>> relaxed_rotations(const PoseGraph<Pose>& graph,
                                                PoseNetworkSolver<Pose>& solver) {
  constexpr int kRotation = Pose::kDof - Pose::kDim;
  using Matrix = typename PoseNetworkSolver<Pose>::Matrix;
  std::vector<typename PoseNetworkSolver<Pose>::Term> terms;
  for (const auto& f : graph.relative_poses) {
    const double kappa =
        f.weight * f.information.template bottomRightCorner<kRotation, kRotation>().trace() / kRotation;
    terms.push_back({f.T_i_j.rotation_matrix().transpose(), Matrix::Zero(), kappa * Matrix::Identity()});
  }
  Matrices<Pose> start;
  for (const auto& pose : graph.poses) start.push_back(pose.rotation_matrix().transpose());
  return solver.solve(Pose::kDim, std::move(start), terms);
}

/// The translations, in the first columns, given the rotations.
template <class Pose>
std::optional<Matrices<Pose>> translations(const PoseGraph<Pose>& graph, const Matrices<Pose>& rotations,
                                           PoseNetworkSolver<Pose>& solver) {
  constexpr int kDim = Pose::kDim;
  using Matrix = typename PoseNetworkSolver<Pose>::Matrix;
  std::vector<typename PoseNetworkSolver<Pose>::Term> terms;
  for (const auto& f : graph.relative_poses) {
    const Matrix& r_i = rotations[f.i.index()];
    const Matrix r_z_w = (r_i * f.T_i_j.rotation_matrix()).transpose();
    Matrix translation = Matrix::Zero();
    translation.col(0) = r_i * f.T_i_j.translation();
    terms.push_back(
        {Matrix::Identity(), translation,
         f.weight * r_z_w.transpose() * f.information.template topLeftCorner<kDim, kDim>() * r_z_w});
  }
  Matrices<Pose> start(graph.poses.size(), Matrix::Zero());
  for (std::size_t p = 0; p < start.size(); ++p) start[p].col(0) = graph.poses[p].translation();
  return solver.solve(1, std::move(start), terms);
}

}  // namespace

template <class Pose>
ChordalResult initialise_chordal(PoseGraph<Pose>& graph) {
  const auto held = held_poses(graph);
  PoseNetworkSolver<Pose> solver(graph, held);
  auto rotations = relaxed_rotations(graph, solver);
  if (!rotations) return ChordalResult::kNotPositiveDefinite;
  for (auto& r : *rotations) r = nearest_rotation(typename PoseNetworkSolver<Pose>::Matrix(r.transpose()));
  const auto positions = translations(graph, *rotations, solver);
  if (!positions) return ChordalResult::kNotPositiveDefinite;
  for (std::size_t p = 0; p < held.size(); ++p)
    if (!held[p]) graph.poses[p] = make_pose((*positions)[p].col(0), (*rotations)[p]);
  return ChordalResult::kDone;
}

template ChordalResult initialise_chordal(PoseGraph<SE2>&);
template ChordalResult initialise_chordal(PoseGraph<SE3>&);

}  // namespace radioslam
