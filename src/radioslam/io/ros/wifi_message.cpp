#include "radioslam/io/ros/wifi_message.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr std::array kAddressNames{"bssid",   "mac",         "macaddr", "macaddress", "macattr",
                                   "address", "accesspoint", "apmac",   "addr"};
constexpr std::array kLevelNames{"rssi",   "rss",      "signallevel", "signalstrength",
                                 "signal", "strength", "level",       "dbm"};
constexpr std::array kFrequencyNames{"frequency", "freq", "frequencymhz"};
constexpr std::array kChannelNames{"channel", "chan"};
constexpr std::array kNetworkNames{"ssid", "essid"};
constexpr std::array kWifiWords{"wifi", "wireless", "wlan"};

/// wireless_msgs/Connection, which recordings of ROS 2 may lack.
constexpr std::string_view kConnection = "wireless_msgs/Connection";
constexpr std::string_view kConnectionFields =
    "float32 bitrate\nint16 txpower\nstring link_quality_raw\nfloat32 link_quality\nint16 signal_level\n"
    "int16 noise_level\nstring essid\nstring bssid\nfloat64 frequency\n";

/// mac_addr, macAddr and macaddr[3] are macaddr.
std::string plain_name(std::string_view name) {
  std::string plain = lower_case(name.substr(0, name.find('[')));
  std::erase(plain, '_');
  return plain;
}

/// The values of one scope, by plain name: those of a list together.
using Values = std::map<std::string, std::vector<RosValue>>;

/// The first of these names, also in the plural.
template <std::size_t kCount>
const std::vector<RosValue>* first_of(const Values& values, const std::array<const char*, kCount>& names) {
  for (const char* name : names)
    for (const char* ending : {"", "s"})
      if (const auto found = values.find(std::string(name) + ending); found != values.end())
        return &found->second;
  return nullptr;
}

bool names_wifi(const std::string& name) {
  const std::string lower = lower_case(name);
  return std::any_of(kWifiWords.begin(), kWifiWords.end(),
                     [&](const char* word) { return lower.find(word) != std::string::npos; });
}

/// The addresses of a field: texts, or one of six bytes.
std::vector<std::string> addresses_in(const std::vector<RosValue>& values) {
  std::vector<std::string> addresses;
  const bool is_bytes = values.size() == MacAddress::kBytes &&
                        std::all_of(values.begin(), values.end(), [](const RosValue& value) {
                          return value.is_integer && value.text.empty();
                        });
  if (is_bytes) {
    MacAddress address;
    for (const RosValue& value : values)
      address.value = address.value << 8U | (static_cast<std::uint64_t>(std::llround(value.number)) & 0xffU);
    return {format_mac_address(address)};
  }
  for (const RosValue& value : values) addresses.push_back(canonical_bssid(value.text));
  return addresses;
}

/// 0 if it is unknown.
float frequency_mhz(const Values& values, std::size_t k) {
  const auto* frequency = first_of(values, kFrequencyNames);
  if (frequency != nullptr && k < frequency->size() && (*frequency)[k].number > 0)
    return static_cast<float>(megahertz((*frequency)[k].number));
  const auto* channel = first_of(values, kChannelNames);
  if (channel == nullptr || k >= channel->size()) return 0;
  const auto carrier_hz = carrier_of_channel_hz(std::llround((*channel)[k].number));
  return carrier_hz ? static_cast<float>(megahertz(*carrier_hz)) : 0;
}

void add_readings(const Values& values, Stamp stamp, WifiMessage& read) {
  const auto *address = first_of(values, kAddressNames), *level = first_of(values, kLevelNames);
  if (address == nullptr || level == nullptr) return;
  const std::vector<std::string> addresses = addresses_in(*address);
  if (addresses.size() != level->size()) return void(++read.invalid);
  for (std::size_t k = 0; k < addresses.size(); ++k) {
    const double level_dbm = (*level)[k].number;
    if (!parse_bssid(addresses[k]) || !(level_dbm < 0) || !std::isfinite(level_dbm))
      ++read.invalid;
    else
      read.rows.push_back({stamp, addresses[k], frequency_mhz(values, k), static_cast<float>(level_dbm)});
  }
}

bool has_readings(const RosDefinition& definition, bool is_named_after_wifi) {
  std::map<std::string, Values> scopes;
  for (const std::string& name : definition.names()) {
    const std::size_t point = name.rfind('.');
    const std::string scope = point == std::string::npos ? "" : name.substr(0, point);
    scopes[scope][plain_name(point == std::string::npos ? name : name.substr(point + 1))];
  }
  return std::any_of(scopes.begin(), scopes.end(), [&](const auto& scope) {
    const Values& values = scope.second;
    const bool is_wifi = is_named_after_wifi || first_of(values, kNetworkNames) != nullptr ||
                         first_of(values, kFrequencyNames) != nullptr ||
                         first_of(values, kChannelNames) != nullptr;
    return is_wifi && first_of(values, kAddressNames) != nullptr && first_of(values, kLevelNames) != nullptr;
  });
}

}  // namespace

std::optional<RosDefinition> wifi_definition_of(const RosTopic& topic) {
  const bool is_known = topic.definition.empty() && topic.type == kConnection;
  if (topic.definition.empty() && !is_known) return std::nullopt;
  auto definition = RosDefinition::parse(topic.type, is_known ? kConnectionFields : topic.definition);
  if (!definition || !has_readings(*definition, names_wifi(topic.type) || names_wifi(topic.name)))
    return std::nullopt;
  return definition;
}

WifiMessage read_wifi_message(const RosDefinition& definition, const RosMessage& message) {
  std::map<std::string, Values> scopes;
  std::vector<std::string> order;
  Stamp stamp;
  definition.read(message, [&](const RosValue& value) {
    if (value.stamp && value.name == "stamp" && stamp == Stamp{}) stamp = *value.stamp;
    const auto [scope, is_new] = scopes.try_emplace(value.scope);
    if (is_new) order.push_back(value.scope);
    scope->second[plain_name(value.name)].push_back(value);
  });
  WifiMessage read;
  for (const std::string& scope : order)
    add_readings(scopes[scope], stamp == Stamp{} ? message.stamp : stamp, read);
  return read;
}

}  // namespace radioslam
