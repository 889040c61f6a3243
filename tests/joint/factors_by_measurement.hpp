// The factors that closures have in the joint graph.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {

/// The factor of each of `count` measurements of one source; nothing for those without a factor.
inline std::vector<std::optional<std::size_t>> factors_by_measurement(
    const std::vector<FactorOrigin>& origins, FactorSource source, std::size_t count) {
  std::vector<std::optional<std::size_t>> factors(count);
  for (std::size_t k = 0; k < origins.size(); ++k)
    if (origins[k].source == source) factors[origins[k].measurement] = k;
  return factors;
}

}  // namespace radioslam
