// radioslam import iw, iwlist, nmcli, airodump, pcap: what WiFi tools heard becomes a robot's wifi.csv.
#pragma once

#include "radioslam/cli/import_options.hpp"

namespace radioslam::cli {

/// Lists that iw, iwlist or nmcli printed, in files or folders of files.
void import_printed_scans(const ImportOptions& options);

void import_airodump(const ImportOptions& options);

void import_wifi_captures(const ImportOptions& options);

}  // namespace radioslam::cli
