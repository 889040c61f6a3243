// The key `csi` of mission.yaml: a robot's WiFi card.
//
//   csi: {mac: "00:16:ea:00:00:01", channel: 108, antennas: [front]}
//
// The address by which others know its packets, the number of the channel it listened on, and which of the
// robot's `antennas` its receive chains have, in the channel's order; without them one at the body's origin.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/io/team_names.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// A card as it stands in the file, before its antennas are known.
struct CsiSettings {
  struct NamedAntenna {
    std::string name;
    std::size_t line;
  };
  std::optional<MacAddress> address;
  double carrier_hz = 0;
  std::vector<NamedAntenna> antennas;
};

/// Overrides what stands in `settings`. Refuses an address that is none, a channel that there is not, and an
/// antenna listed twice.
void read_csi_settings(const Text& text, const YAML::Node& node, CsiSettings& settings);

/// The card without captures. Refuses an antenna that the robot does not have.
CsiRecording csi_recording(const Text& text, const CsiSettings& settings, const Antennas& antennas);

/// Adds a card's antennas to those of its robot, under names of their own where they have none yet, and
/// returns their names in the channel's order; none for a single one at the body's origin.
std::vector<std::string> name_csi_antennas(const CsiRecording& csi, Antennas& antennas);

}  // namespace radioslam
