// An order of fingerprints in which neighbours hear the same access points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"

namespace radioslam {

/// Orders `members` (places in `all`): cuts them in two by the access point that most nearly half of them
/// hear, those that do first, and so on down to `part`. `access_points` is more than any index.
/// Time: entries times the depth of the cuts.
void order_by_place(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part,
                    std::span<std::uint32_t> members);

}  // namespace radioslam
