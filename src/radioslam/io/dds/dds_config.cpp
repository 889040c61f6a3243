#include "radioslam/io/dds/dds_config.hpp"

namespace radioslam {
namespace {

// A datagram that fits into one frame of the network: a lost fragment of a larger one would cost the whole,
// and fills the buffer in which the kernel joins them.
constexpr const char* kMessageBytes = "1400B";
constexpr const char* kFragmentBytes = "1300B";
// Beyond that many unacknowledged bytes a writer waits; with less, a robot that leaves would stop the others.
constexpr const char* kUnacknowledgedBytes = "16MB";
// Of the kernel, for what arrives at once: two clouds of a megabyte. It gives what net.core.rmem_max allows.
constexpr const char* kReceivedBytes = "4MB";
// How soon a reader asks for what is missing, and a writer asks what is: with three of ten packets lost each
// way, 50 messages of 6 kB within a second are there 1 to 4 s later, with Cyclone's 100 ms each 6 to 11 s.
constexpr const char* kRepeatDelay = "20ms";
constexpr const char* kHeartbeat = "50ms";
// How often robots that are not there are looked for: one that comes back into reach is found that soon.
constexpr const char* kDiscoveryInterval = "3s";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

std::string interfaces(const std::string& interface) {
  if (interface.empty()) return {};
  const bool is_address = interface.find_first_not_of("0123456789.") == std::string::npos;
  return element("Interfaces", std::string("<NetworkInterface ") + (is_address ? "address" : "name") + "=\"" +
                                   escaped(interface) + "\"/>");
}

std::string peers(const std::vector<std::string>& addresses) {
  std::string list;
  for (const std::string& address : addresses) list += "<Peer address=\"" + escaped(address) + "\"/>";
  return list.empty() ? list : element("Peers", list);
}

}  // namespace

std::string cyclone_config(const DdsConfig& config, const std::optional<std::string>& cyclonedds_uri) {
  const std::string general =
      interfaces(config.interface) +
      element("AllowMulticast", config.discovery == DdsDiscovery::kPeers ? "false" : "spdp") +
      element("MaxMessageSize", kMessageBytes) + element("FragmentSize", kFragmentBytes);
  const std::string discovery = element("ExternalDomainId", std::to_string(config.domain)) +
                                element("ParticipantIndex", "auto") +
                                element("MaxAutoParticipantIndex", std::to_string(config.robots_per_host)) +
                                peers(config.peers) + element("SPDPInterval", kDiscoveryInterval);
  const std::string internal = element("NackDelay", kRepeatDelay) + element("HeartbeatInterval", kHeartbeat) +
                               element("Watermarks", element("WhcHigh", kUnacknowledgedBytes)) +
                               "<SocketReceiveBufferSize min=\"default\" max=\"" + kReceivedBytes + "\"/>";
  const std::string own = element("CycloneDDS", "<Domain id=\"any\">" + element("General", general) +
                                                    element("Discovery", discovery) +
                                                    element("Internal", internal) + "</Domain>");
  return cyclonedds_uri && !cyclonedds_uri->empty() ? own + "," + *cyclonedds_uri : own;
}

}  // namespace radioslam
