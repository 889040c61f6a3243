// Readings of access points in messages of WiFi drivers, which have types of their own: read by the names of
// their fields.
//
// A message, or each element of a list in it, has a reading if it has an address (bssid, mac, macaddr,
// macattr, address, access_point; a text, or six bytes) and a level in dBm (rssi, rss, signal_level, signal,
// signal_strength, strength, level). So do two lists of the same length in one message (macs, strengths). The
// frequency is that of a field freq or frequency in Hz to GHz, or else of the channel, or unknown. Because
// Bluetooth has addresses and levels, too, there is also a name of the network, a frequency or a channel, or
// the type or topic is named after WiFi. Such are wireless_msgs/Connection, rf_msgs/AccessPoints,
// wifi_scan/Fingerprint, pr2_msgs/AccessPoint, cob_msgs/AccessPoint, wifi_ddwrt/SiteSurvey,
// jsk_network_tools/WifiStatus, ff_msgs/CommStateStamped, wifi_localization/WifiState and others.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/io/ros/ros_definition.hpp"
#include "radioslam/io/ros/ros_topics.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {

/// The definition of a topic's messages if they have readings: that in the recording, or a known one where
/// rosbag2 stored none (wireless_msgs/Connection).
std::optional<RosDefinition> wifi_definition_of(const RosTopic& topic);

struct WifiMessage {
  std::vector<WifiRow> rows;  ///< at the message's stamp, or else its recording time
  std::size_t invalid = 0;    ///< readings without an address, or whose level is not negative
};

/// Refuses (InputError) a message that does not fit the definition.
WifiMessage read_wifi_message(const RosDefinition& definition, const RosMessage& message);

}  // namespace radioslam
