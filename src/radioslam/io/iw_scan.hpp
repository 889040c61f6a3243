// Access points as `iw dev wlan0 scan` or `scan dump` lists them:
//
//   1574407123.123456789                            a line of our own, by `date +%s.%N` before each scan
//   BSS 02:00:00:00:01:00(on wlan0)
//           last seen: 4206.107s [boottime]
//           freq: 2412
//           signal: -53.00 dBm                      -53.-50 dBm is -53.5: iw's way of writing hundredths
//           last seen: 3520 ms ago
//           SSID: ...
//
// Other lines are passed over. A list begins with a line that is a time; where a log has none but boot times,
// it begins where they say that it was printed later, and its time is then that of the machine's boot clock,
// unless another one is told (time_scans).
// A level that is no dBm ("50/100") is none. What the file's end cuts off is left out.
#pragma once

#include "radioslam/io/printed_scans.hpp"

namespace radioslam {

/// Refuses a text without any BSS, and with their line: addresses and numbers that are none, and two levels
/// or frequencies of one BSS.
PrintedLog read_iw_scans(const Text& text);

}  // namespace radioslam
