// Channel state information: what a WiFi card measured of the packets it heard, before any sense is made of
// it.
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

/// A card's address, the first of its six bytes the most significant.
struct MacAddress {
  static constexpr std::size_t kBytes = 6;
  std::uint64_t value = 0;
  friend constexpr auto operator<=>(MacAddress, MacAddress) = default;
};

/// What one packet's training symbols said of the channel.
struct CsiPacket {
  Stamp stamp;                           ///< by the host's clock where the capture has it, else as clock_us
  std::uint32_t clock_us = 0;            ///< of the card: a 1 MHz counter of its own, which wraps
  std::optional<MacAddress> sender;      ///< absent where the capture does not tell
  std::optional<MacAddress> receiver;    ///< likewise
  std::optional<std::uint32_t> counter;  ///< of the frame; the answer to a frame carries the same
  std::array<int, 3> rssi{};             ///< per antenna, in the card's own scale; 0: not used
  int noise_dbm = 0;                     ///< -127: not measured
  int gain_control_db = 0;
  /// Complex channel in the card's own scale, (receiving antennas * streams) x subcarriers; row s * antennas
  /// + a is what antenna a heard of stream s.
  Eigen::MatrixXcf channel;
  int antennas = 0, streams = 0;
};

/// Everything a card wrote down.
struct CsiCapture {
  std::vector<CsiPacket> packets;     ///< as recorded
  std::vector<double> subcarrier_hz;  ///< from the carrier, of every column
  std::optional<double> carrier_hz;   ///< absent where the capture does not tell
  double bandwidth_hz = 0;
  std::vector<std::string> warnings;  ///< what was left out, and where
};

/// A robot's WiFi card and all that it wrote down.
struct CsiRecording {
  std::optional<MacAddress> address;        ///< by which others know its packets
  double carrier_hz = 0;                    ///< of the channel it listened on; 0: not known
  std::vector<Eigen::Vector3d> antennas_m;  ///< in the robot's body frame, in the order of the channel's rows
  std::vector<CsiCapture> captures;         ///< one per file, in the order of their names
};

}  // namespace radioslam
