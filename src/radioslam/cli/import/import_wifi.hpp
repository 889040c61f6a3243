// radioslam import iw, iwlist, nmcli, airodump, pcap: converts output of WiFi tools to a robot's wifi.csv.
#pragma once

#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {

/// Imports scan lists printed by iw, iwlist or nmcli, from files or folders of files.
void import_printed_scans(const ImportOptions& options);

void import_airodump(const ImportOptions& options);

void import_wifi_captures(const ImportOptions& options);

}  // namespace radioslam::cli
