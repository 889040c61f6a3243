#include "radioslam/graph/chordal.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <optional>

#include "radioslam/graph/block_structure.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"

namespace radioslam {
namespace {

/// Linear least squares over the poses of a graph: one d x m matrix X_p per pose, one term per relative
/// pose, min sum |X_j - A X_i - B|^2_W, column by column. Some poses are held at given values.
template <int D>
struct NetworkTerm {
  Eigen::Matrix<double, D, D> a, b, w;  ///< of b the first m columns count
};

/// The structure is analysed once, for any number of solves.
template <class Pose>
class PoseNetworkSolver {
 public:
  using Matrix = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;
  using Term = NetworkTerm<Pose::kDim>;

  PoseNetworkSolver(const PoseGraph<Pose>& graph, const std::vector<bool>& held);

  /// `values` holds X_p in its first `columns` columns; `terms` one per relative pose. Nothing when the
  /// problem is singular.
  auto solve(Eigen::Index columns, std::vector<Matrix> values, const std::vector<Term>& terms)
      -> std::optional<std::vector<Matrix>> {
    if (matrix_.rows() == 0) return values;
    matrix_.set_zero();
    right_side_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(matrix_.rows()), columns);
    for (std::size_t k = 0; k < terms.size(); ++k)
      if (ends_[k][0] != ends_[k][1]) add_term(k, terms[k], values);
    if (cholesky_->factorize(matrix_) != Factorization::kDone) return std::nullopt;
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

 private:
  void add_term(std::size_t factor, const Term& term, const std::vector<Matrix>& values) {
    const auto& [i, j] = ends_[factor];
    const auto& slots = slots_[factor];
    const Matrix wa = term.w * term.a, wb = term.w * term.b;
    const auto add_at = [&](std::int32_t block, const Matrix& diagonal, const Matrix& right_side) {
      if (block < 0) return;
      const auto b = static_cast<std::size_t>(block);
      matrix_.diagonal(b) += diagonal;
      right_side_.middleRows<Pose::kDim>(static_cast<Eigen::Index>(matrix_.offset(b))) +=
          right_side.leftCols(right_side_.cols());
    };
    const auto [block_i, block_j] = slots.blocks;
    add_at(block_j, term.w, block_i < 0 ? Matrix(wb + wa * values[i]) : wb);
    add_at(block_i, term.a.transpose() * wa,
           block_j < 0 ? Matrix(wa.transpose() * values[j] - term.a.transpose() * wb)
                       : Matrix(-term.a.transpose() * wb));
    if (slots.lower[0] < 0) return;
    auto lower = matrix_.lower(static_cast<std::size_t>(slots.lower[0]));
    if (block_j > block_i)
      lower -= wa;
    else
      lower -= wa.transpose();
  }

  std::vector<std::array<std::size_t, 2>> ends_;  ///< i and j of every relative pose
  VariableBlocks blocks_;
  SymmetricBlockMatrix matrix_;
  std::vector<FactorSlots<2>> slots_;
  Eigen::MatrixXd right_side_;
  std::optional<BlockCholesky> cholesky_;
};

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
RelativePoseNetwork relative_pose_network(const PoseGraph<Pose>& graph) {
  RelativePoseNetwork n{std::vector<std::size_t>(graph.poses.size() + 1, 0), {}};
  for (const auto& f : graph.relative_poses) {
    ++n.starts[f.i.index() + 1];
    ++n.starts[f.j.index() + 1];
  }
  for (std::size_t p = 0; p < graph.poses.size(); ++p) n.starts[p + 1] += n.starts[p];
  n.factors.resize(2 * graph.relative_poses.size());
  auto next = n.starts;
  for (std::size_t k = 0; k < graph.relative_poses.size(); ++k) {
    n.factors[next[graph.relative_poses[k].i.index()]++] = k;
    n.factors[next[graph.relative_poses[k].j.index()]++] = k;
  }
  return n;
}

template <class Pose>
std::vector<TreeStep> breadth_first_tree(const PoseGraph<Pose>& graph) {
  const auto network = relative_pose_network(graph);
  std::vector<bool> reached(graph.poses.size(), false);
  std::vector<TreeStep> steps;
  const auto add_root = [&](std::size_t pose) {
    reached[pose] = true;
    steps.push_back({pose, pose, 0});
  };
  std::size_t done = 0;
  const auto spread = [&] {
    for (; done < steps.size(); ++done) {
      const std::size_t pose = steps[done].pose;
      for (std::size_t k = network.starts[pose]; k < network.starts[pose + 1]; ++k) {
        const auto& f = graph.relative_poses[network.factors[k]];
        const std::size_t other = f.i.index() == pose ? f.j.index() : f.i.index();
        if (reached[other]) continue;
        reached[other] = true;
        steps.push_back({other, pose, network.factors[k]});
      }
    }
  };
  for (std::size_t p = 0; p < graph.pose_fixed.size(); ++p)
    if (graph.pose_fixed[p]) add_root(p);
  spread();
  for (std::size_t p = 0; p < graph.poses.size(); ++p)
    if (!reached[p]) {
      add_root(p);
      spread();
    }
  return steps;
}

template RelativePoseNetwork relative_pose_network(const PoseGraph<SE2>&);
template RelativePoseNetwork relative_pose_network(const PoseGraph<SE3>&);
template std::vector<TreeStep> breadth_first_tree(const PoseGraph<SE2>&);
template std::vector<TreeStep> breadth_first_tree(const PoseGraph<SE3>&);

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
