// Writers and readers of a DDS domain, as everyone announces them, and why some exchange nothing.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace radioslam {

enum class DdsReliability : std::uint8_t { kBestEffort, kReliable };
enum class DdsDurability : std::uint8_t { kVolatile, kTransientLocal, kTransient, kPersistent };
enum class DdsLiveliness : std::uint8_t { kAutomatic, kByParticipant, kByTopic };
enum class DdsOwnership : std::uint8_t { kShared, kExclusive };
enum class DdsOrder : std::uint8_t { kByReception, kBySource };

/// A writer or a reader, with what of its QoS decides whether they match.
struct DdsEndpoint {
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

  std::array<std::uint8_t, 16> participant{};
  std::string topic, type;  ///< as DDS has them
  bool is_own = false;      ///< of this robot
  DdsReliability reliability = DdsReliability::kBestEffort;
  DdsDurability durability = DdsDurability::kVolatile;
  DdsLiveliness liveliness = DdsLiveliness::kAutomatic;
  DdsOwnership ownership = DdsOwnership::kShared;
  DdsOrder order = DdsOrder::kByReception;
  std::int64_t deadline_ns = kNever_ns, lease_ns = kNever_ns;
  std::vector<std::int16_t> representations = {};  ///< numbers of XTypes; none: plain CDR (0)
};

/// In a line with the names of ROS, why nothing passes from a writer to a reader of the same topic, one of
/// them this robot's; empty if it does, and for other topics.
std::string mismatch(const DdsEndpoint& writer, const DdsEndpoint& reader);

}  // namespace radioslam
