// Reads the key `csi` of mission.yaml, which describes a robot's WiFi card:
//
//   csi: {mac: "00:16:ea:00:00:01", channel: 108, antennas: [front]}
//
// `mac` is the sender address of its packets, `channel` the WiFi channel it received on, and `antennas` names
// the antennas of its receive chains, in the order of the CSI (default: a single antenna at the body's
// origin).
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/io/mission/team_names.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// A card as described in the file, before its antennas are resolved.
struct CsiSettings {
  struct NamedAntenna {
    std::string name;
    std::size_t line;
  };
  std::optional<MacAddress> address;
  double carrier_hz = 0;
  std::vector<NamedAntenna> antennas;
};

/// Reads the node and overrides `settings`. Refuses invalid addresses and channels, and repeated antennas.
void read_csi_settings(const Text& text, const YAML::Node& node, CsiSettings& settings);

/// The card with its antennas, without captures. Refuses an antenna that the robot does not have.
CsiRecording csi_recording(const Text& text, const CsiSettings& settings, const Antennas& antennas);

/// Adds a card's antennas to those of its robot, under new names unless they have one, and returns their
/// names in the order of the CSI; returns none for a single antenna at the body's origin.
std::vector<std::string> name_csi_antennas(const CsiRecording& csi, Antennas& antennas);

}  // namespace radioslam
