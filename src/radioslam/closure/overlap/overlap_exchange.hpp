// Distributed overlap search of a team in one process: every robot is a party (overlap_party.hpp), and
// messages are delivered round by round. Finds what the central search finds, and counts what was sent.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "radioslam/closure/overlap/overlap_party.hpp"

namespace radioslam {

struct OverlapTraffic {
  /// Bytes of the messages that each robot sent, by their kind.
  std::vector<std::array<std::uint64_t, kOverlapMessageKinds.size()>> bytes;
  std::uint64_t rounds = 0;  ///< in which some robot asked another one

  OverlapTraffic& operator+=(const OverlapTraffic& other);
};

/// A team's search as TeamOverlapSearch, by messages. Refers to the source.
template <OverlapSource Source>
class TeamOverlapExchange {
 public:
  /// One sensor per robot. Every robot is a party of its own poses; `traffic` is added to.
  TeamOverlapExchange(const Source& source, const std::vector<OverlapSensor>& sensors,
                      const OverlapParams& params, OverlapTraffic& traffic);

  OverlapCounts search(std::uint32_t a, const TakeOverlaps& take) const;

 private:
  using Party = OverlapParty<typename Source::Poses, typename Source::Team>;

  const Source& source_;
  std::vector<Party> parties_;
};

}  // namespace radioslam
