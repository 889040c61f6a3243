#include "radioslam/graph/pose_network.hpp"

#include <Eigen/SVD>
#include <cmath>

namespace radioslam {
namespace {

/// Only the relative poses, with blocks of a translation's size: poses are represented by points.
template <class Pose>
VariableBlocks free_blocks(const PoseGraph<Pose>& graph, const std::vector<bool>& held) {
  VariableBlocks blocks{std::vector<std::int32_t>(graph.poses.size(), -1), {}, {}, {}};
  std::int32_t next = 0;
  for (std::size_t p = 0; p < graph.poses.size(); ++p)
    if (!held[p]) blocks.poses[p] = next++;
  return blocks;
}

template <class Pose>
std::array<Variable, 2> pose_ends(const RelativePoseFactor<Pose>& f) {
  return {variable(f.i), variable(f.j)};
}

template <class Pose>
BlockPattern pose_pattern(const PoseGraph<Pose>& graph, const VariableBlocks& blocks) {
  BlockPattern pattern;
  for (const auto block : blocks.poses)
    if (block >= 0) pattern.sizes.push_back(Pose::kDim);
  for (const auto& f : graph.relative_poses) {
    const auto [a, b] = block_indices(blocks, pose_ends(f));
    if (a >= 0 && b >= 0) pattern.lower.push_back({std::max(a, b), std::min(a, b)});
  }
  sort_lower(pattern);
  return pattern;
}

}  // namespace

template <class Pose>
PoseNetworkSolver<Pose>::PoseNetworkSolver(const PoseGraph<Pose>& graph, const std::vector<bool>& held)
    : blocks_(free_blocks(graph, held)), matrix_(pose_pattern(graph, blocks_)) {
  for (const auto& f : graph.relative_poses) {
    ends_.push_back({f.i.index(), f.j.index()});
    slots_.push_back(factor_slots(matrix_, blocks_, pose_ends(f)));
  }
  if (matrix_.rows() > 0) cholesky_.emplace(matrix_.pattern());
}

template <class Pose>
bool PoseNetworkSolver<Pose>::set_terms(NetworkTerms<Pose> terms) {
  terms_ = std::move(terms);
  if (matrix_.rows() == 0) return true;
  matrix_.set_zero();
  for (std::size_t k = 0; k < terms_.size(); ++k)
    if (ends_[k][0] != ends_[k][1]) add_to_matrix(k);
  return cholesky_->factorize(matrix_) == Factorization::kDone;
}

template <class Pose>
std::optional<PoseMatrices<Pose>> PoseNetworkSolver<Pose>::solve(Eigen::Index columns,
                                                                 PoseMatrices<Pose> values) {
  if (matrix_.rows() == 0) return values;
  right_side_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(matrix_.rows()), columns);
  for (std::size_t k = 0; k < terms_.size(); ++k)
    if (ends_[k][0] != ends_[k][1]) add_to_right_side(k, values);
  for (Eigen::Index c = 0; c < columns; ++c) {
    const Eigen::VectorXd x = cholesky_->solve(right_side_.col(c));
    if (!x.allFinite()) return std::nullopt;
    for (std::size_t p = 0; p < values.size(); ++p)
      if (blocks_.poses[p] >= 0)
        values[p].col(c) = x.segment<Pose::kDim>(
            static_cast<Eigen::Index>(matrix_.offset(static_cast<std::size_t>(blocks_.poses[p]))));
  }
  return values;
}

template <class Pose>
double PoseNetworkSolver<Pose>::cost(Eigen::Index columns, const PoseMatrices<Pose>& values) const {
  double sum = 0;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const PoseMatrix<Pose> r = values[ends_[k][1]] - terms_[k].a * values[ends_[k][0]] - terms_[k].b;
    const PoseMatrix<Pose> weighted = terms_[k].w * r;
    for (Eigen::Index c = 0; c < columns; ++c) sum += r.col(c).dot(weighted.col(c));
  }
  return sum;
}

template <class Pose>
void PoseNetworkSolver<Pose>::add_to_matrix(std::size_t factor) {
  const auto& term = terms_[factor];
  const auto& slots = slots_[factor];
  const PoseMatrix<Pose> wa = term.w * term.a;
  const auto [block_i, block_j] = slots.blocks;
  if (block_j >= 0) matrix_.diagonal(static_cast<std::size_t>(block_j)) += term.w;
  if (block_i >= 0) matrix_.diagonal(static_cast<std::size_t>(block_i)) += term.a.transpose() * wa;
  if (slots.lower[0] < 0) return;
  auto lower = matrix_.lower(static_cast<std::size_t>(slots.lower[0]));
  if (block_j > block_i)
    lower -= wa;
  else
    lower -= wa.transpose();
}

template <class Pose>
void PoseNetworkSolver<Pose>::add_to_right_side(std::size_t factor, const PoseMatrices<Pose>& values) {
  const auto& [i, j] = ends_[factor];
  const auto& term = terms_[factor];
  const PoseMatrix<Pose> wa = term.w * term.a, wb = term.w * term.b;
  const auto add_at = [&](std::int32_t block, const PoseMatrix<Pose>& right_side) {
    if (block < 0) return;
    right_side_.middleRows<Pose::kDim>(static_cast<Eigen::Index>(
        matrix_.offset(static_cast<std::size_t>(block)))) += right_side.leftCols(right_side_.cols());
  };
  const auto [block_i, block_j] = slots_[factor].blocks;
  add_at(block_j, block_i < 0 ? PoseMatrix<Pose>(wb + wa * values[i]) : wb);
  add_at(block_i, block_j < 0 ? PoseMatrix<Pose>(wa.transpose() * values[j] - term.a.transpose() * wb)
                              : PoseMatrix<Pose>(-term.a.transpose() * wb));
}

template <class Pose>
NetworkTerms<Pose> rotation_terms(const PoseGraph<Pose>& graph) {
  constexpr int kRotation = Pose::kDof - Pose::kDim;
  NetworkTerms<Pose> terms;
  for (const auto& f : graph.relative_poses) {
    const double kappa =
        f.weight * f.information.template bottomRightCorner<kRotation, kRotation>().trace() / kRotation;
    terms.push_back({f.T_i_j.rotation_matrix().transpose(), PoseMatrix<Pose>::Zero(),
                     kappa * PoseMatrix<Pose>::Identity()});
  }
  return terms;
}

template <class Pose>
NetworkTerms<Pose> translation_terms(const PoseGraph<Pose>& graph, const PoseMatrices<Pose>& rotations) {
  constexpr int kDim = Pose::kDim;
  NetworkTerms<Pose> terms;
  for (const auto& f : graph.relative_poses) {
    const PoseMatrix<Pose>& r_i = rotations[f.i.index()];
    const PoseMatrix<Pose> r_z_w = (r_i * f.T_i_j.rotation_matrix()).transpose();
    PoseMatrix<Pose> translation = PoseMatrix<Pose>::Zero();
    translation.col(0) = r_i * f.T_i_j.translation();
    terms.push_back(
        {PoseMatrix<Pose>::Identity(), translation,
         f.weight * r_z_w.transpose() * f.information.template topLeftCorner<kDim, kDim>() * r_z_w});
  }
  return terms;
}

Eigen::Matrix2d nearest_rotation(const Eigen::Matrix2d& m) {
  return SE2({0, 0}, std::atan2(m(1, 0) - m(0, 1), m.trace())).rotation_matrix();
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

SE2 make_pose(const Eigen::Vector2d& translation, const Eigen::Matrix2d& rotation) {
  return {translation, std::atan2(rotation(1, 0), rotation(0, 0))};
}
SE3 make_pose(const Eigen::Vector3d& translation, const Eigen::Matrix3d& rotation) {
  return {translation, Eigen::Quaterniond(rotation)};
}

#define RADIOSLAM_POSE_NETWORK(Pose)                                  \
  template class PoseNetworkSolver<Pose>;                             \
  template NetworkTerms<Pose> rotation_terms(const PoseGraph<Pose>&); \
  template NetworkTerms<Pose> translation_terms(const PoseGraph<Pose>&, const PoseMatrices<Pose>&);
RADIOSLAM_POSE_NETWORK(SE2)
RADIOSLAM_POSE_NETWORK(SE3)
#undef RADIOSLAM_POSE_NETWORK

}  // namespace radioslam
