// The one door for captures of channel state information, whatever card wrote them.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads a capture of the Intel 5300, of an ESP32 or of Nexmon CSI, which it recognises by its content.
/// Refuses (InputError) what the cards' own readers refuse, and other files, by name where it knows them.
CsiCapture read_csi_capture(const std::string& path);

/// The same of bytes; `name` is for messages.
CsiCapture read_csi_capture(const std::string& name, std::string_view bytes);

}  // namespace radioslam
