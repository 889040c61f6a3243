#include "radioslam/joint/factor_origin.hpp"

#include <algorithm>

namespace radioslam {

std::size_t count_factors(const std::vector<FactorOrigin>& origins, FactorSource source) {
  return static_cast<std::size_t>(std::count_if(
      origins.begin(), origins.end(), [&](const FactorOrigin& origin) { return origin.source == source; }));
}

}  // namespace radioslam
