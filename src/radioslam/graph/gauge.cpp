#include "radioslam/graph/gauge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/linearisation.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// Eigenvalue of the scaled information, relative to the largest, below which a direction counts as
/// unobserved.
constexpr double kUnobservedRatio = 1e-9;
/// Information of an unobserved direction, relative to the largest observed one: as good as held, since a
/// heading known to a hundredth of a radian would add metres to the far end of a drive.
constexpr double kPenalty = 1e6;

/// Disjoint sets whose representative is their first member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  std::int32_t find(std::int32_t i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  std::int32_t& parent(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<std::int32_t> parent_;
};

/// The place of a pose or point in the joint numbering; -1 for a drift, a bias or none.
template <class Pose>
std::int32_t member(const PoseGraph<Pose>& graph, const Variable& v) {
  if (v.kind == VariableKind::kPose) return v.id;
  if (v.kind == VariableKind::kPoint) return static_cast<std::int32_t>(graph.poses.size()) + v.id;
  return -1;
}

/// Information of one absolute factor about a rigid motion of its component, perturbing pose `base`.
template <class Pose, class Factor>
typename Pose::Jacobian absolute_information(const PoseGraph<Pose>& graph, const Factor& factor,
                                             const Pose& where, const Pose& base) {
  const auto linear = linearise(graph, factor);
  const auto j = (std::get<0>(linear.jacobians) * (where.inverse() * base).adjoint()).eval();
  return weight(factor) * (j.transpose() * information(factor) * j);
}

/// The end as a pose; a point's is turned like the world.
template <class Pose>
Pose end_pose(const PoseGraph<Pose>& graph, const RangeEnd<Pose>& end) {
  if (end.pose.valid()) return graph.poses[end.pose.index()];
  typename Pose::Tangent xi = Pose::Tangent::Zero();
  xi.template head<Pose::kDim>() = graph.points[end.point.index()];
  return Pose::exp(xi);
}

/// The information about a rigid motion, per component's first pose.
template <class Pose>
std::map<std::int32_t, typename Pose::Jacobian> rigid_information(const PoseGraph<Pose>& graph,
                                                                  const Components<Pose>& components) {
  std::map<std::int32_t, typename Pose::Jacobian> sums;
  const auto add = [&](const auto& factor, std::int32_t component, const Pose& where) {
    if (static_cast<std::size_t>(component) >= graph.poses.size()) return;  // points alone
    const auto [entry, _] = sums.try_emplace(component, Pose::Jacobian::Zero());
    const Pose& base = graph.poses[static_cast<std::size_t>(component)];
    entry->second += absolute_information(graph, factor, where, base);
  };
  for (const auto& f : graph.pose_priors) add(f, components.of_pose[f.i.index()], graph.poses[f.i.index()]);
  for (const auto& f : graph.positions) {
    const auto component =
        f.i.pose.valid() ? components.of_pose[f.i.pose.index()] : components.of_point[f.i.point.index()];
    add(f, component, end_pose(graph, f.i));
  }
  return sums;
}

/// Square roots of the largest information of a translation and of a rotation, per axis: a tilted frame mixes
/// the axes of each, so none has a scale of its own.
template <class Pose>
typename Pose::Tangent scale_of(const typename Pose::Jacobian& information) {
  const auto diagonal = information.diagonal();
  const double scale = diagonal.maxCoeff();
  const auto root = [&](double x) { return x > kUnobservedRatio * scale ? std::sqrt(x) : std::sqrt(scale); };
  typename Pose::Tangent d;
  d.template head<Pose::kDim>().setConstant(root(diagonal.template head<Pose::kDim>().maxCoeff()));
  d.template tail<Pose::kDof - Pose::kDim>().setConstant(
      root(diagonal.template tail<Pose::kDof - Pose::kDim>().maxCoeff()));
  return d;
}

/// kPenalty sum over unobserved n of (D n)(D n)^T, with D the scale of translations and rotations; the null
/// space is that of the information scaled by D, so that metres and radians compare.
template <class Pose>
typename Pose::Jacobian unobserved_penalty(const typename Pose::Jacobian& information) {
  using Tangent = typename Pose::Tangent;
  const Tangent d = scale_of<Pose>(information);
  const typename Pose::Jacobian scaled =
      d.cwiseInverse().asDiagonal() * information * d.cwiseInverse().asDiagonal();
  const auto eigen = symmetric_eigen(scaled);
  typename Pose::Jacobian penalty = Pose::Jacobian::Zero();
  for (int k = 0; k < Pose::kDof; ++k) {
    if (eigen.values[k] > kUnobservedRatio * eigen.values[Pose::kDof - 1]) continue;
    const Tangent v = d.cwiseProduct(eigen.vectors.col(k));
    penalty += v * v.transpose();
  }
  return kPenalty * penalty;
}

}  // namespace

template <class Pose>
Components<Pose> connected_components(const PoseGraph<Pose>& graph) {
  DisjointSets sets(graph.poses.size() + graph.points.size());
  for_each_factor(graph, [&](const auto& factor) {
    std::int32_t first = -1;
    for (const Variable& v : variables(factor)) {
      const std::int32_t m = member(graph, v);
      if (m < 0) continue;
      if (first < 0) first = m;
      sets.join(first, m);
    }
  });
  Components<Pose> c;
  const auto poses = static_cast<std::int32_t>(graph.poses.size());
  for (std::int32_t i = 0; i < poses; ++i) c.of_pose.push_back(sets.find(i));
  for (std::size_t i = 0; i < graph.points.size(); ++i)
    c.of_point.push_back(sets.find(poses + static_cast<std::int32_t>(i)));
  return c;
}

template <class Pose>
Gauge<Pose> resolve_gauge(const PoseGraph<Pose>& graph) {
  const std::size_t n = graph.poses.size();
  RADIOSLAM_CHECK(graph.pose_fixed.empty() || graph.pose_fixed.size() == n, "pose_fixed needs one per pose");
  const auto components = connected_components(graph);
  Gauge<Pose> gauge{graph.pose_fixed, {}};
  gauge.held.resize(n, false);
  std::vector<bool> settled(n, false);
  for (std::size_t i = 0; i < n; ++i)
    if (gauge.held[i]) settled[static_cast<std::size_t>(components.of_pose[i])] = true;

  for (const auto& [component, information] : rigid_information(graph, components)) {
    const auto first = static_cast<std::size_t>(component);
    if (settled[first] || !(information.diagonal().maxCoeff() > 0)) continue;
    const auto penalty = unobserved_penalty<Pose>(information);
    if (!penalty.isZero(0)) gauge.penalties.push_back({PoseId(first), penalty});
    settled[first] = true;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (!settled[static_cast<std::size_t>(components.of_pose[i])]) {
      gauge.held[i] = true;
      settled[static_cast<std::size_t>(components.of_pose[i])] = true;
    }
  return gauge;
}

template Components<SE2> connected_components(const PoseGraph<SE2>&);
template Components<SE3> connected_components(const PoseGraph<SE3>&);
template Gauge<SE2> resolve_gauge(const PoseGraph<SE2>&);
template Gauge<SE3> resolve_gauge(const PoseGraph<SE3>&);

}  // namespace radioslam
