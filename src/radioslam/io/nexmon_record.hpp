// What Broadcom's WiFi chips with Nexmon CSI's firmware (Schulz, Wegemer, Hollick: nexmon.org/csi) send for
// every frame, receiving core and spatial stream: a UDP packet of, little endian,
//   u16 0x1111, [i8 RSSI in dBm, u8 frame control | u16 0x1111, in the older firmware,] 6 bytes MAC, u16
//   sequence control, u16 core (three bits) and stream (three bits), u16 chanspec, u16 chip, and per
//   subcarrier, from the carrier up and on from the lowest, four bytes:
//     4339 and 43455c0: i16 real, i16 imaginary;
//     4358 and 4366c0: from the highest bit used on down sign, real, sign, imaginary, exponent (two's
//     complement) of 1, 8, 1, 8, 5 and of 1, 11, 1, 11, 6 bits.
// The newer firmware writes what the receiver said of the frame over the values of a few subcarriers.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/io/csi_band.hpp"

namespace radioslam {

/// What one core heard of one stream.
struct NexmonRecord {
  MacAddress sender;
  std::uint16_t sequence_control = 0;  ///< of the frame: number * 16 + fragment; 0 where it has none
  std::uint8_t core = 0, stream = 0;
  std::uint16_t chanspec = 0;
  std::uint16_t chip = 0;
  std::optional<int> rssi_dbm;                ///< absent in the older firmware
  std::optional<std::uint8_t> frame_control;  ///< likewise; the first of its two bytes
  std::string_view values;

  std::complex<float> value(int subcarrier) const;
};

/// Whether a UDP payload starts as such a packet does.
bool is_nexmon_record(std::string_view payload);

/// Refuses (InputError with byte `at` of the file) a payload that is cut off, unknown chips, chanspecs other
/// than of 20, 40 and 80 MHz around 2.4 and 5 GHz, and another number of values than the chanspec's.
NexmonRecord read_nexmon_record(const std::string& name, std::size_t at, std::string_view payload);

/// The columns that carry something in packets of every kind: at 20 MHz those of 802.11a, +-26; at 40 and 80
/// MHz those of 802.11n and ac, and of the newer firmware without +2, which it writes over.
CapturedBand nexmon_band(const NexmonRecord& record);

}  // namespace radioslam
