// Reads WiFi scans from the output of `iw dev wlan0 scan` or `iw dev wlan0 scan dump`:
//
//   1574407123.123456789                            printed by `date +%s.%N` before each scan
//   BSS 02:00:00:00:01:00(on wlan0)
//           last seen: 4206.107s [boottime]
//           freq: 2412
//           signal: -53.00 dBm                      -53.-50 dBm means -53.5: iw prints hundredths so
//           last seen: 3520 ms ago
//           SSID: ...
//
// Other indented lines are skipped, other lines also named in a note. A scan list begins with a line that is
// a time (read_printed_time). In a log that has only boot times, a list begins where these show a later
// printing time; its time is then that of the boot clock, unless another one is given (time_scans). A level
// without dBm ("50/100") counts as missing. An incomplete entry at the end of the file is left out.
#pragma once

#include "radioslam/io/wifi/wifi_scan_log.hpp"

namespace radioslam {

/// Leaves out radios with a malformed address or number, or with a second level or frequency, with a warning.
/// Refuses (InputError) a text without any BSS, or of which most are malformed.
ScanListLog read_iw_scans(const Text& text);

}  // namespace radioslam
