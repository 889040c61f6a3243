// Iterates over all factor lists of a graph, and lists the variables of each factor.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// References to the graph's lists, always in this order.
template <class Pose>
auto factor_lists(const PoseGraph<Pose>& graph) {
  return std::tie(graph.relative_poses, graph.ranges, graph.bearings, graph.relative_points, graph.positions,
                  graph.pose_priors, graph.drift_priors, graph.range_bias_priors);
}

template <class Pose, class Body>
void for_each_factor(const PoseGraph<Pose>& graph, Body&& body) {
  const auto one_list = [&](const auto& list) {
    for (const auto& factor : list) body(factor);
  };
  std::apply([&](const auto&... lists) { (one_list(lists), ...); }, factor_lists(graph));
}

enum class VariableKind : std::uint8_t { kNone, kPose, kPoint, kDrift, kBias };

struct Variable {
  VariableKind kind = VariableKind::kNone;
  std::int32_t id = -1;
  bool operator==(const Variable&) const = default;
};

inline Variable variable(PoseId id) { return {VariableKind::kPose, id.value}; }
inline Variable variable(PointId id) { return {VariableKind::kPoint, id.value}; }
inline Variable variable(DriftId id) {
  return id.valid() ? Variable{VariableKind::kDrift, id.value} : Variable{};
}
inline Variable variable(BiasId id) {
  return id.valid() ? Variable{VariableKind::kBias, id.value} : Variable{};
}
template <class Pose>
Variable variable(const RangeEnd<Pose>& end) {
  return end.pose.valid() ? variable(end.pose) : variable(end.point);
}

/// The variables of a factor, in the order of its Jacobians.
template <class Pose>
std::array<Variable, 3> variables(const RelativePoseFactor<Pose>& f) {
  return {variable(f.i), variable(f.j), variable(f.drift)};
}
template <class Pose>
std::array<Variable, 3> variables(const RangeFactor<Pose>& f) {
  return {variable(f.i), variable(f.j), f.drift.valid() ? variable(f.drift) : variable(f.bias)};
}
template <class Pose>
std::array<Variable, 2> variables(const BearingFactor<Pose>& f) {
  return {variable(f.i), variable(f.j)};
}
template <class Pose>
std::array<Variable, 2> variables(const RelativePointFactor<Pose>& f) {
  return {variable(f.i), variable(f.j)};
}
template <class Pose>
std::array<Variable, 1> variables(const PositionFactor<Pose>& f) {
  return {variable(f.i)};
}
template <class Pose>
std::array<Variable, 1> variables(const PosePriorFactor<Pose>& f) {
  return {variable(f.i)};
}
inline std::array<Variable, 1> variables(const DriftPriorFactor& f) { return {variable(f.i)}; }
inline std::array<Variable, 2> variables(const RangeBiasPriorFactor& f) {
  return {variable(f.i), variable(f.of)};
}

}  // namespace radioslam
