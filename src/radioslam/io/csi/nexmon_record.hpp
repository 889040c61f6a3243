// Parses the UDP packets that Broadcom WiFi chips with the Nexmon CSI firmware (Schulz, Wegemer, Hollick:
// nexmon.org/csi) send for every frame, receiving core and spatial stream; little endian:
//   u16 0x1111, [i8 RSSI in dBm, u8 frame control | u16 0x1111, in the older firmware,] 6 bytes MAC, u16
//   sequence control, u16 core (three bits) and stream (three bits), u16 chanspec, u16 chip, and per
//   subcarrier, from the carrier up and on from the lowest, four bytes:
//     4339 and 43455c0: i16 real, i16 imaginary;
//     4358 and 4366c0: from the highest bit used on down sign, real, sign, imaginary, exponent (two's
//     complement) of 1, 8, 1, 8, 5 and of 1, 11, 1, 11, 6 bits.
// The newer firmware overwrites the values of a few subcarriers with information on the frame.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/io/csi/csi_band.hpp"

namespace radioslam {

/// The CSI of one stream at one core.
struct NexmonRecord {
  MacAddress sender;
  std::uint16_t sequence_control = 0;  ///< of the frame: number * 16 + fragment; 0 if it has none
  std::uint8_t core = 0, stream = 0;
  std::uint16_t chanspec = 0;
  std::uint16_t chip = 0;
  std::optional<int> rssi_dbm;                ///< absent in the older firmware
  std::optional<std::uint8_t> frame_control;  ///< first of its two bytes; absent in the older firmware
  std::string_view values;

  std::complex<float> value(int subcarrier) const;
};

/// Whether a UDP payload begins like such a packet.
bool is_nexmon_record(std::string_view payload);

/// Refuses (InputError with byte `at` of the file) a truncated payload, unknown chips, chanspecs other than
/// 20, 40 and 80 MHz at 2.4 or 5 GHz, and a number of values that does not match the chanspec.
NexmonRecord read_nexmon_record(const std::string& name, std::size_t at, std::string_view payload);

/// The subcarriers that are used by packets of every kind: at 20 MHz those of 802.11a (-26 to 26), at 40 and
/// 80 MHz those of 802.11n and ac; for the newer firmware without +2, which it overwrites.
CapturedBand nexmon_band(const NexmonRecord& record);

}  // namespace radioslam
