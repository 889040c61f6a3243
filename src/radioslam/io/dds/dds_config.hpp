// How a robot finds others by DDS, and what that means for Cyclone DDS.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace radioslam {

enum class DdsDiscovery {
  kPeers,      ///< only at the addresses listed; no multicast at all
  kMulticast,  ///< also whoever answers to multicast, which finds but never carries data: WiFi sends it at
               ///< the lowest rate
};

struct DdsConfig {
  std::uint32_t domain = 0;  ///< as ROS_DOMAIN_ID, at most 232
  DdsDiscovery discovery = DdsDiscovery::kPeers;
  std::vector<std::string> peers;      ///< addresses or names of hosts, this one included if it runs others
  std::string interface = {};          ///< name or address; empty: the one that Cyclone prefers
  std::uint32_t robots_per_host = 10;  ///< participants that are looked for at each address
};

inline constexpr std::uint32_t kLastDdsDomain = 232;

/// The configuration as XML. `outside`: the domain's number on the wire where it is not its own, as of
/// several domains in one process. What the user sets by CYCLONEDDS_URI comes last, so that it prevails.
std::string cyclone_config(const DdsConfig& config, const std::optional<std::string>& cyclonedds_uri);

}  // namespace radioslam
