#include "radioslam/io/csi/csi_yaml.hpp"

#include <algorithm>

#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/yaml_map.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

MacAddress address_at(const Text& text, const YAML::Node& node) {
  const std::string value = scalar_at(text, node, "mac");
  const auto address = parse_mac_address(value);
  if (!address)
    text.fail(line_of(node), "mac '" + value + "' is not a MAC address such as 00:16:ea:00:00:01");
  return *address;
}

double carrier_at(const Text& text, const YAML::Node& node) {
  const std::string value = scalar_at(text, node, "channel");
  const auto number = parse_integer(value);
  const auto carrier_hz = number ? carrier_of_channel_hz(*number) : std::nullopt;
  if (!carrier_hz)
    text.fail(line_of(node), "channel '" + value + "' is not the number of a WiFi channel (1-14 or 32-177)");
  return *carrier_hz;
}

std::vector<CsiSettings::NamedAntenna> antennas_at(const Text& text, const YAML::Node& node) {
  if (!node.IsSequence()) text.fail(line_of(node), "antennas in csi is not a list of names");
  std::vector<CsiSettings::NamedAntenna> antennas;
  for (const auto& entry : node) {
    const std::string name = scalar_at(text, entry, "an antenna's name");
    for (const auto& [other, line] : antennas)
      if (other == name)
        text.fail(line_of(entry), "antenna '" + name + "' appears twice in csi",
                  InputError::Kind::kDuplicate);
    antennas.push_back({name, line_of(entry)});
  }
  return antennas;
}

std::string unused_name(const Antennas& antennas) {
  std::size_t number = 1;
  while (antennas.contains("csi" + std::to_string(number))) ++number;
  return "csi" + std::to_string(number);
}

}  // namespace

void read_csi_settings(const Text& text, const YAML::Node& node, CsiSettings& settings) {
  read_yaml_map(
      text, node, "csi",
      {{"mac", [&](const YAML::Node& value) { settings.address = address_at(text, value); }},
       {"channel", [&](const YAML::Node& value) { settings.carrier_hz = carrier_at(text, value); }},
       {"antennas", [&](const YAML::Node& value) { settings.antennas = antennas_at(text, value); }}});
}

CsiRecording csi_recording(const Text& text, const CsiSettings& settings, const Antennas& antennas) {
  CsiRecording csi;
  csi.address = settings.address;
  csi.carrier_hz = settings.carrier_hz;
  for (const auto& [name, line] : settings.antennas) {
    const auto found = antennas.find(name);
    if (found == antennas.end())
      text.fail(line, "unknown antenna '" + name + "' in csi", InputError::Kind::kSpelling);
    csi.antennas_m.push_back(found->second);
  }
  if (csi.antennas_m.empty()) csi.antennas_m.emplace_back(0, 0, 0);
  return csi;
}

std::vector<std::string> name_csi_antennas(const CsiRecording& csi, Antennas& antennas) {
  std::vector<std::string> names;
  if (csi.antennas_m.size() == 1 && csi.antennas_m.front().isZero(0)) return names;
  for (const Eigen::Vector3d& antenna_m : csi.antennas_m) {
    auto named = std::find_if(antennas.begin(), antennas.end(), [&](const auto& entry) {
      return entry.second == antenna_m && std::find(names.begin(), names.end(), entry.first) == names.end();
    });
    if (named == antennas.end()) named = antennas.emplace(unused_name(antennas), antenna_m).first;
    names.push_back(named->first);
  }
  return names;
}

}  // namespace radioslam
