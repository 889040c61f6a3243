// Reads WiFi scans from the output of `iwlist wlan0 scan`:
//
//   1574407123.123456789                            printed by `date +%s.%N` before each scan
//   wlan0     Scan completed :
//             Cell 01 - Address: 02:00:00:00:01:00
//                       Channel:6
//                       Frequency:2.437 GHz (Channel 6)
//                       Quality=58/70  Signal level=-52 dBm
//                       Extra: Last beacon: 120ms ago
//
// ':' instead of '=' means that the driver did not mark the level as new; such levels are kept and counted. A
// level without dBm ("60/100") counts as missing. Other lines are skipped. An incomplete entry at the end of
// the file is left out.
#pragma once

#include "radioslam/io/wifi/wifi_scan_log.hpp"

namespace radioslam {

/// Leaves out cells with a malformed address or number, with a warning. Refuses (InputError) a text without
/// any cell, or of which most are malformed.
ScanListLog read_iwlist_scans(const Text& text);

}  // namespace radioslam
