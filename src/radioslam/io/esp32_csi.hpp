// Serial captures of the ESP32 by ESP32-CSI-Tool and by Espressif's esp-csi; esp32_line.hpp tells their
// lines. One antenna and one stream. rssi[0] is in dBm; the stamp is real_timestamp where the host has set
// the chip's clock, and local_timestamp otherwise; the counter is esp-csi's `id`: of the frame in csi_recv,
// of the receiver in csi_recv_router.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Whether the bytes hold a line of channel state information.
bool is_esp32_csi(std::string_view bytes);

/// Reads a whole capture, from every packet the training field, on one channel, that most values were
/// measured with. Refuses (InputError, with the line) an empty file and one without any line that can be
/// used. Passed over or left out, with a warning that counts them: other lines (the chip's log), lines that
/// are torn or contradict themselves, and packets without that training field.
CsiCapture read_esp32_csi(const std::string& name, std::string_view bytes);

}  // namespace radioslam
