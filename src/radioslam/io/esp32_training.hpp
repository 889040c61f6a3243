// Where the subcarriers of an ESP32's packet stand among its values (ESP-IDF, "Wi-Fi Channel State
// Information"): the legacy training field first, then, of 802.11n, the high throughput field, of one stream
// or of two by space time block code. Every field of 20 MHz runs 0..31, -32..-1 from the carrier, or, where
// the channel has a second one below or above, in the halves 0..63 or -64..-1 of both together; of 40 MHz
// 0..63, -64..-1, with the block code 0..60, -60..-1.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/io/csi_band.hpp"
#include "radioslam/io/esp32_line.hpp"

namespace radioslam {

/// One training field's columns that carry something.
struct TrainingField {
  CapturedBand band;                ///< the carrier is the centre of the field's 20 or 40 MHz
  std::vector<std::size_t> places;  ///< of every column among the packet's complex values
};

/// The legacy field, and the (first) high throughput one where the packet has it. Without the first two
/// values where the chip says that they are invalid, or does not say. Refuses (InputError with the line)
/// packets with other numbers of values than these fields have, and unknown channels.
/// A chip that was told to leave the legacy field out is not recognised.
std::vector<TrainingField> training_fields(const TextLines& at, const Esp32Packet& packet);

}  // namespace radioslam
