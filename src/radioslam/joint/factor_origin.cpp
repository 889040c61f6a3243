#include "radioslam/joint/factor_origin.hpp"

#include <algorithm>

namespace radioslam {

std::vector<std::optional<std::size_t>> factors_by_measurement(const std::vector<FactorOrigin>& origins,
                                                               FactorSource source, std::size_t count) {
  std::vector<std::optional<std::size_t>> factors(count);
  for (std::size_t k = 0; k < origins.size(); ++k)
    if (origins[k].source == source) factors[origins[k].measurement] = k;
  return factors;
}

std::size_t count_factors(const std::vector<FactorOrigin>& origins, FactorSource source) {
  return static_cast<std::size_t>(std::count_if(
      origins.begin(), origins.end(), [&](const FactorOrigin& origin) { return origin.source == source; }));
}

}  // namespace radioslam
