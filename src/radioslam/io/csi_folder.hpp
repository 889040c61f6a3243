// The captures of a robot's WiFi card: the files of one folder.
#pragma once

#include <filesystem>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Every file of the folder but hidden ones, in the order of their names; nothing without such a folder.
/// Refuses a file that is no capture.
std::vector<CsiCapture> read_csi_folder(const std::filesystem::path& folder);

/// Writes capture.dat, or capture-1.dat and so on where there are several; none for captures without packets.
void write_csi_folder(const std::filesystem::path& folder, const std::vector<CsiCapture>& captures);

}  // namespace radioslam
