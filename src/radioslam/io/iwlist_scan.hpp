// Access points as `iwlist wlan0 scan` lists them:
//
//   1574407123.123456789                            a line of our own, by `date +%s.%N` before each scan
//   wlan0     Scan completed :
//             Cell 01 - Address: 02:00:00:00:01:00
//                       Channel:6
//                       Frequency:2.437 GHz (Channel 6)
//                       Quality=58/70  Signal level=-52 dBm
//                       Extra: Last beacon: 120ms ago
//
// ':' in place of '=' says that the driver did not mark the level as new; it is kept and counted. A level
// that is no dBm ("60/100", or none) is none. Other lines are passed over. What the file's end cuts off is
// left out.
#pragma once

#include "radioslam/io/printed_scans.hpp"

namespace radioslam {

/// Refuses a text without any cell, and with their line: addresses and numbers that are none.
PrintedLog read_iwlist_scans(const Text& text);

}  // namespace radioslam
