// Maps the CSI values of an ESP32 packet to subcarriers (ESP-IDF, "Wi-Fi Channel State Information"). The
// legacy training field comes first, then, for 802.11n, the high throughput field of one stream, or of two
// streams with space-time block code. The subcarriers of a 20 MHz field are ordered 0..31, -32..-1 from the
// carrier, or, if there is a secondary channel below or above, cover the half 0..63 or -64..-1 of both
// channels together. Those of a 40 MHz field are ordered 0..63, -64..-1, or 0..60, -60..-1 with block code.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/io/csi/csi_band.hpp"
#include "radioslam/io/csi/esp32_line.hpp"

namespace radioslam {

/// The used subcarriers of one training field.
struct TrainingField {
  CapturedBand band;                ///< the carrier is the centre of the field's 20 or 40 MHz
  std::vector<std::size_t> places;  ///< index of each subcarrier's value among the packet's complex values
};

/// The legacy field and, if present, the (first) high throughput field. The first two values are left out if
/// the chip marks them as invalid or does not state their validity. Refuses (InputError with the line)
/// numbers of values that do not match these fields, and unknown channels. Chips configured to omit the
/// legacy field are not recognised.
std::vector<TrainingField> training_fields(const TextLines& at, const Esp32Packet& packet);

}  // namespace radioslam
