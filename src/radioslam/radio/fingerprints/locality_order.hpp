// Locality order: orders fingerprints so that neighbours detect the same access points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"

namespace radioslam {

/// Orders `members` (indices into `all`): splits them by the access point that closest to half of them
/// detect, those that do first, and repeats down to groups of `part`. `access_points` exceeds any index.
/// Cost: entries times depth of the splits.
void order_by_locality(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part,
                       std::span<std::uint32_t> members);

}  // namespace radioslam
