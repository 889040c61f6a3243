#include "radioslam/graph/marginals.hpp"

#include <limits>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr double kLeastDamping = 1e-15, kMostDamping = 1e-8;  // relative to the diagonal

template <class Pose>
Eigen::Index dimension(const Variable& v) {
  RADIOSLAM_CHECK(v.kind != VariableKind::kNone, "a covariance needs a variable");
  if (v.kind == VariableKind::kPose) return Pose::kDof;
  if (v.kind == VariableKind::kPoint) return Pose::kDim;
  return v.kind == VariableKind::kDrift ? Drift::SizeAtCompileTime : 1;
}

/// Of a variable outside the equations with itself: zero for a held pose, infinite for one never measured.
template <class Pose>
Eigen::MatrixXd outside_covariance(const Variable& v) {
  const Eigen::Index n = dimension<Pose>(v);
  if (v.kind == VariableKind::kPose) return Eigen::MatrixXd::Zero(n, n);
  return Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity()).asDiagonal();
}

}  // namespace

template <class Pose>
std::optional<Marginals<Pose>> Marginals<Pose>::compute(const PoseGraph<Pose>& graph) {
  NormalEquations<Pose> equations(graph);
  if (equations.empty()) return Marginals(std::move(equations), std::nullopt, graph.poses);
  equations.linearise(graph);
  // Parts that hang together by next to nothing are singular up to rounding; the least damping that helps
  // states them about as uncertain as doubles can tell.
  double damping = 0;
  while (equations.factorize(damping) != Factorization::kDone) {
    damping = damping == 0 ? kLeastDamping : 10 * damping;
    if (damping > kMostDamping) return std::nullopt;
  }
  auto inverse = equations.cholesky().selected_inverse();
  return Marginals(std::move(equations), std::move(inverse), graph.poses);
}

template <class Pose>
Eigen::MatrixXd Marginals<Pose>::block(const Variable& a, const Variable& b) const {
  const std::int32_t block_a = equations_.blocks().of(a), block_b = equations_.blocks().of(b);
  if (block_a < 0 && a == b) return outside_covariance<Pose>(a);
  if (block_a < 0 || block_b < 0) return Eigen::MatrixXd::Zero(dimension<Pose>(a), dimension<Pose>(b));
  const auto row = static_cast<std::size_t>(block_a), column = static_cast<std::size_t>(block_b);
  if (row == column) return inverse_->diagonal(row);
  if (const auto known = inverse_->block(row, column)) return *known;
  const auto first_row = static_cast<Eigen::Index>(equations_.matrix().offset(row));
  return equations_.cholesky().inverse_columns(column).middleRows(first_row, dimension<Pose>(a));
}

template <class Pose>
Eigen::MatrixXd Marginals<Pose>::joint(const Variable& a, const Variable& b) const {
  RADIOSLAM_CHECK(a != b, "a joint covariance needs two variables");
  const Eigen::MatrixXd cross = block(a, b);
  Eigen::MatrixXd joint(cross.rows() + cross.cols(), cross.rows() + cross.cols());
  joint << block(a, a), cross, cross.transpose(), block(b, b);
  return joint;
}

template <class Pose>
typename Marginals<Pose>::PoseCovariance Marginals<Pose>::relative_pose(PoseId i, PoseId j) const {
  if (i == j) return PoseCovariance::Zero();
  return relative_pose(i, j, pose(i), pose(j), block(variable(i), variable(j)));
}

template <class Pose>
typename Marginals<Pose>::PoseCovariance Marginals<Pose>::relative_pose(
    PoseId i, PoseId j, const PoseCovariance& of_i, const PoseCovariance& of_j,
    const PoseCovariance& of_i_with_j) const {
  // T_i_j Exp(xi_j - Ad(T_j_i) xi_i).
  const PoseCovariance by_i = -(poses_[j.index()].inverse() * poses_[i.index()]).adjoint();
  const PoseCovariance cross = by_i * of_i_with_j;
  return by_i * of_i * by_i.transpose() + of_j + cross + cross.transpose();
}

template <class Pose>
std::vector<typename Marginals<Pose>::PoseCovariance> Marginals<Pose>::relative_poses_with(PoseId i) const {
  const std::int32_t own = equations_.blocks().of(variable(i));
  Eigen::MatrixXd columns;
  if (own >= 0) columns = equations_.cholesky().inverse_columns(static_cast<std::size_t>(own));
  const PoseCovariance of_i = pose(i);
  std::vector<PoseCovariance> result;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const PoseId j(k);
    PoseCovariance of_j_with_i = PoseCovariance::Zero();
    if (const std::int32_t other = equations_.blocks().of(variable(j)); own >= 0 && other >= 0)
      of_j_with_i = columns.template middleRows<Pose::kDof>(
          static_cast<Eigen::Index>(equations_.matrix().offset(static_cast<std::size_t>(other))));
    result.push_back(i == j  ? PoseCovariance(PoseCovariance::Zero())
                     : i < j ? relative_pose(i, j, of_i, pose(j), of_j_with_i.transpose())
                             : relative_pose(j, i, pose(j), of_i, of_j_with_i));
  }
  return result;
}

template <class Pose>
std::vector<typename Marginals<Pose>::PoseCovariance> Marginals<Pose>::relative_poses(
    const std::vector<PoseId>& of) const {
  std::vector<std::size_t> blocks;
  std::vector<std::optional<Eigen::Index>> rows;  // nothing for a held pose
  for (const PoseId i : of) {
    const std::int32_t block = equations_.blocks().of(variable(i));
    rows.push_back(block < 0 ? std::nullopt
                             : std::optional(static_cast<Eigen::Index>(Pose::kDof * blocks.size())));
    if (block >= 0) blocks.push_back(static_cast<std::size_t>(block));
  }
  const Eigen::MatrixXd joint =
      blocks.empty() ? Eigen::MatrixXd() : equations_.cholesky().inverse_between(blocks);
  const auto covariance = [&](std::size_t a, std::size_t b) -> PoseCovariance {
    if (!rows[a] || !rows[b]) return PoseCovariance::Zero();
    return joint.block<Pose::kDof, Pose::kDof>(*rows[a], *rows[b]);
  };
  std::vector<PoseCovariance> result;
  for (std::size_t a = 0; a < of.size(); ++a)
    for (std::size_t b = a + 1; b < of.size(); ++b)
      result.push_back(
          of[a] == of[b] ? PoseCovariance(PoseCovariance::Zero())
                         : relative_pose(of[a], of[b], covariance(a, a), covariance(b, b), covariance(a, b)));
  return result;
}

template <class Pose>
std::vector<typename Marginals<Pose>::PoseColumns> Marginals<Pose>::with_functions(
    const std::vector<PoseId>& of, const std::vector<PoseColumns>& coefficients) const {
  RADIOSLAM_CHECK(of.size() == coefficients.size() && !of.empty(), "every pose has coefficients");
  const Eigen::Index functions = coefficients.front().cols();
  const auto rows = [&](PoseId i) -> std::optional<Eigen::Index> {
    const std::int32_t block = equations_.blocks().of(variable(i));
    if (block < 0) return std::nullopt;
    return static_cast<Eigen::Index>(equations_.matrix().offset(static_cast<std::size_t>(block)));
  };
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(equations_.matrix().rows()), functions);
  for (std::size_t k = 0; k < of.size(); ++k)
    if (const auto row = rows(of[k])) values.middleRows<Pose::kDof>(*row) += coefficients[k];
  for (Eigen::Index c = 0; c < functions && !equations_.empty(); ++c)
    values.col(c) = equations_.cholesky().solve(values.col(c));
  std::vector<PoseColumns> result(of.size(), PoseColumns::Zero(Pose::kDof, functions));
  for (std::size_t k = 0; k < of.size(); ++k)
    if (const auto row = rows(of[k])) result[k] = values.middleRows<Pose::kDof>(*row);
  return result;
}

template class Marginals<SE2>;
template class Marginals<SE3>;

}  // namespace radioslam
