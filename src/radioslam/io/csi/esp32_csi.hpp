// Reads serial captures of the ESP32 written by ESP32-CSI-Tool or Espressif's esp-csi (esp32_line.hpp
// describes the lines). They have one antenna and one stream. rssi[0] is in dBm. The stamp is real_timestamp
// if the host has set the chip's clock, otherwise local_timestamp. The counter is esp-csi's `id`, which
// counts frames in csi_recv and receptions in csi_recv_router.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Whether the bytes contain a line with CSI.
bool is_esp32_csi(std::string_view bytes);

/// Reads a whole capture. Of all combinations of channel and training field, the one with the most values is
/// kept. Refuses (InputError, with the line) an empty file and one without usable lines. Left out, with a
/// warning that counts them, are other lines (the chip's log), truncated or inconsistent lines, and packets
/// without the training field that is kept.
CsiCapture read_esp32_csi(const std::string& name, std::string_view bytes);

}  // namespace radioslam
