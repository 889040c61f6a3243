#include "radioslam/graph/block_structure.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {

std::int32_t VariableBlocks::of(const Variable& v) const {
  switch (v.kind) {
    case VariableKind::kNone:
      return -1;
    case VariableKind::kPose:
      return poses[static_cast<std::size_t>(v.id)];
    case VariableKind::kPoint:
      return points[static_cast<std::size_t>(v.id)];
    case VariableKind::kDrift:
      return drifts[static_cast<std::size_t>(v.id)];
    case VariableKind::kBias:
      return biases[static_cast<std::size_t>(v.id)];
  }
  return -1;
}

void sort_lower(BlockPattern& pattern) {
  const auto by_column = [](const BlockPlace& a, const BlockPlace& b) {
    return std::pair(a.column, a.row) < std::pair(b.column, b.row);
  };
  std::sort(pattern.lower.begin(), pattern.lower.end(), by_column);
  pattern.lower.erase(std::unique(pattern.lower.begin(), pattern.lower.end()), pattern.lower.end());
}

template <class Pose>
VariableBlocks number_blocks(const PoseGraph<Pose>& graph, const std::vector<bool>& held) {
  VariableBlocks b{std::vector<std::int32_t>(graph.poses.size(), -1),
                   std::vector<std::int32_t>(graph.points.size(), -1),
                   std::vector<std::int32_t>(graph.drifts.size(), -1),
                   std::vector<std::int32_t>(graph.range_biases.size(), -1)};
  for_each_factor(graph, [&](const auto& factor) {
    for (const Variable& v : variables(factor)) {
      if (v.kind == VariableKind::kPoint) b.points[static_cast<std::size_t>(v.id)] = 0;
      if (v.kind == VariableKind::kDrift) b.drifts[static_cast<std::size_t>(v.id)] = 0;
      if (v.kind == VariableKind::kBias) b.biases[static_cast<std::size_t>(v.id)] = 0;
    }
  });
  std::int32_t next = 0;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i]) b.poses[i] = next++;
  for (auto& block : b.points) block = block < 0 ? -1 : next++;
  for (auto& block : b.drifts) block = block < 0 ? -1 : next++;
  for (auto& block : b.biases) block = block < 0 ? -1 : next++;
  return b;
}

template <class Pose>
BlockPattern block_pattern(const PoseGraph<Pose>& graph, const VariableBlocks& blocks) {
  BlockPattern pattern;
  const auto add_sizes = [&](const std::vector<std::int32_t>& list, int size) {
    for (const auto block : list)
      if (block >= 0) pattern.sizes.push_back(size);
  };
  add_sizes(blocks.poses, Pose::kDof);
  add_sizes(blocks.points, Pose::kDim);
  add_sizes(blocks.drifts, static_cast<int>(Drift::SizeAtCompileTime));
  add_sizes(blocks.biases, 1);
  for_each_factor(graph, [&](const auto& factor) {
    const auto indices = block_indices(blocks, variables(factor));
    for_each_pair<std::tuple_size_v<decltype(indices)>>([&](std::size_t, std::size_t a, std::size_t b) {
      if (indices[a] >= 0 && indices[b] >= 0)
        pattern.lower.push_back({std::max(indices[a], indices[b]), std::min(indices[a], indices[b])});
    });
  });
  sort_lower(pattern);
  return pattern;
}

template VariableBlocks number_blocks(const PoseGraph<SE2>&, const std::vector<bool>&);
template VariableBlocks number_blocks(const PoseGraph<SE3>&, const std::vector<bool>&);
template BlockPattern block_pattern(const PoseGraph<SE2>&, const VariableBlocks&);
template BlockPattern block_pattern(const PoseGraph<SE3>&, const VariableBlocks&);

}  // namespace radioslam
