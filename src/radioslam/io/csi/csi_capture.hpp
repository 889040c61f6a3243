// Reads captures of channel state information (CSI) from any supported WiFi card.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads a capture of the Intel 5300, an ESP32 or Nexmon CSI; the format is recognised by the content.
/// Refuses (InputError) whatever the reader of the format refuses, and other files, naming their format if it
/// is known.
CsiCapture read_csi_capture(const std::string& path);

/// The same for bytes in memory; `name` is used in messages.
CsiCapture read_csi_capture(const std::string& name, std::string_view bytes);

// Reads and writes the folder with the CSI captures of a robot's WiFi card.

/// Reads all files of the folder except hidden ones, sorted by name; returns nothing if the folder does not
/// exist. Refuses (InputError) a file that is not a capture.
std::vector<CsiCapture> read_csi_folder(const std::filesystem::path& folder);

/// Writes capture.dat, or capture-1.dat and so on if there are several. Captures without packets are not
/// written.
void write_csi_folder(const std::filesystem::path& folder, const std::vector<CsiCapture>& captures);

}  // namespace radioslam
