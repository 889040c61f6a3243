// Reads and writes the folder with the CSI captures of a robot's WiFi card.
#pragma once

#include <filesystem>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads all files of the folder except hidden ones, sorted by name; returns nothing if the folder does not
/// exist. Refuses (InputError) a file that is not a capture.
std::vector<CsiCapture> read_csi_folder(const std::filesystem::path& folder);

/// Writes capture.dat, or capture-1.dat and so on if there are several. Captures without packets are not
/// written.
void write_csi_folder(const std::filesystem::path& folder, const std::vector<CsiCapture>& captures);

}  // namespace radioslam
