// Messages of this project's own ROS 2 package, ros/radioslam_msgs: what robots measure by radio, for which
// ROS has no types. Frames and units as the .msg files state them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/mission/csi.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

inline constexpr std::string_view kRangeMeasurementType = "radioslam_msgs/RangeMeasurement",
                                  kAngleMeasurementType = "radioslam_msgs/AngleMeasurement",
                                  kWifiScanType = "radioslam_msgs/WifiScan",
                                  kCsiPacketType = "radioslam_msgs/CsiPacket";

struct RosRangeMeasurement {
  RosHeader header;
  std::string antenna, other, other_antenna;
  double range_m = 0, sigma_m = 0;
};

struct RosAngleMeasurement {
  RosHeader header;
  std::string transmitter, transmitter_antenna;
  std::vector<AoaPath> paths;
};

struct RosWifiReading {
  std::string bssid;
  float frequency_mhz = 0, rssi_dbm = 0;
};

struct RosWifiScan {
  RosHeader header;
  std::vector<RosWifiReading> readings;
};

struct RosCsiPacket {
  RosHeader header;  ///< its stamp is the packet's
  CsiPacket packet;
  double carrier_hz = 0, bandwidth_hz = 0;
  std::vector<double> subcarrier_hz;
};

/// Each refuses (InputError) bytes that are no such message.
RosRangeMeasurement read_range_measurement(const RosMessage& message);
RosAngleMeasurement read_angle_measurement(const RosMessage& message);
RosWifiScan read_wifi_scan(const RosMessage& message);
/// Refuses also a channel of another size than antennas, streams and subcarriers have.
RosCsiPacket read_csi_packet(const RosMessage& message);

std::string encode_cdr(const RosRangeMeasurement& message);
std::string encode_cdr(const RosAngleMeasurement& message);
std::string encode_cdr(const RosWifiScan& message);
std::string encode_cdr(const RosCsiPacket& message);

}  // namespace radioslam
