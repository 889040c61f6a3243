// Reads WiFi scans from NetworkManager's `nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list`:
//
//   1574407123.123456789                                 printed by `date +%s.%N` before each list
//   02\:00\:00\:00\:01\:00:686F6D65:6:2437 MHz:82        ':' and '\' in a field are escaped by '\'
//
// The table for people, `nmcli dev wifi list` in any language, is read where it has a BSSID.
//
// SIGNAL is a percentage that NetworkManager computes from dBm (nm_wifi_utils_level_to_quality, since 2007):
//   SIGNAL = 100 - trunc(100 (-40 - dBm) / 60), dBm between -100 and -40,
// Every whole dBm gives a different SIGNAL, so the conversion is inverted exactly; -100 and -40 dBm also
// represent anything weaker or stronger. Other values of SIGNAL are a driver's own percentage and are mapped
// by the same line.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/wifi/wifi_scan_log.hpp"

namespace radioslam {

/// The fields of the example above.
std::vector<std::string> default_nmcli_fields();

/// Splits "BSSID,CHAN,SIGNAL" into names in upper case. Refuses a list in which BSSID or SIGNAL is missing or
/// repeated.
std::vector<std::string> parse_nmcli_fields(const std::string& list);

/// The level that a SIGNAL from 0 to 100 represents; `exact` if NetworkManager computes it from a whole dBm.
struct NmcliLevel {
  double rssi_dbm = 0;
  bool exact = true;
};
NmcliLevel level_of_nmcli_signal(int signal);

/// Leaves out rows with another number of fields and malformed addresses, SIGNALs and frequencies, with a
/// warning. Refuses (InputError) a text without rows, or of which most are malformed.
ScanListLog read_nmcli_lists(const Text& text, const std::vector<std::string>& fields);

}  // namespace radioslam
