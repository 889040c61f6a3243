// Reads captures of channel state information (CSI) from any supported WiFi card.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads a capture of the Intel 5300, an ESP32 or Nexmon CSI; the format is recognised by the content.
/// Refuses (InputError) whatever the reader of the format refuses, and other files, naming their format if it
/// is known.
CsiCapture read_csi_capture(const std::string& path);

/// The same for bytes in memory; `name` is used in messages.
CsiCapture read_csi_capture(const std::string& name, std::string_view bytes);

}  // namespace radioslam
