// Channel state information (CSI): what a WiFi card recorded of received packets, unprocessed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

/// MAC address; the first of its six bytes is the most significant.
struct MacAddress {
  static constexpr std::size_t kBytes = 6;
  std::uint64_t value = 0;
  friend constexpr auto operator<=>(MacAddress, MacAddress) = default;
};

/// Channel estimate of one packet.
struct CsiPacket {
  Stamp stamp;                           ///< by the host's clock if recorded, else from clock_us
  std::uint32_t clock_us = 0;            ///< the card's own 1 MHz counter, which wraps around
  std::optional<MacAddress> sender;      ///< absent if not recorded
  std::optional<MacAddress> receiver;    ///< absent if not recorded
  std::optional<std::uint32_t> counter;  ///< of the frame; the reply to a frame carries the same
  std::array<int, 3> rssi{};             ///< per antenna, in the card's scale; 0: unused
  int noise_dbm = 0;                     ///< -127: not measured
  int gain_control_db = 0;
  /// Complex channel in the card's scale, (receiving antennas * streams) x subcarriers; row s * antennas + a
  /// is antenna a, stream s.
  Eigen::MatrixXcf channel;
  int antennas = 0, streams = 0;
};

/// Contents of one capture file.
struct CsiCapture {
  std::vector<CsiPacket> packets;     ///< as recorded
  std::vector<double> subcarrier_hz;  ///< offset from the carrier, per column
  std::optional<double> carrier_hz;   ///< absent if not recorded
  double bandwidth_hz = 0;
  std::vector<std::string> warnings;  ///< skipped records and their positions
};

/// A robot's WiFi card and its captures.
struct CsiRecording {
  std::optional<MacAddress> address;        ///< sender address of its packets
  double carrier_hz = 0;                    ///< of the recorded channel; 0: unknown
  std::vector<Eigen::Vector3d> antennas_m;  ///< in the robot's body frame, in the order of the channel's rows
  std::vector<CsiCapture> captures;         ///< one per file, in the order of their names
};

}  // namespace radioslam
