// Access points as NetworkManager's `nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list` prints them:
//
//   1574407123.123456789                                 a line of our own, by `date +%s.%N` before each list
//   02\:00\:00\:00\:01\:00:686F6D65:6:2437 MHz:82        ':' and '\' inside a field follow a '\'
//
// SIGNAL is no dBm. NetworkManager makes it of one (nm_wifi_utils_level_to_quality, since 2007):
//   SIGNAL = 100 - trunc(100 (-40 - dBm) / 60), dBm between -100 and -40,
// of which every whole dBm gives another SIGNAL, so it is undone exactly; -100 and -40 also stand for what is
// weaker and stronger. Other SIGNALs are a driver's own percentage; they are put on the same line.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/printed_scans.hpp"

namespace radioslam {

/// What was asked of nmcli's -f in the example.
std::vector<std::string> usual_nmcli_fields();

/// "BSSID,CHAN,SIGNAL" as names, in upper case. Refuses a list without BSSID or SIGNAL, or with one twice.
std::vector<std::string> parse_nmcli_fields(const std::string& list);

/// What a SIGNAL from 0 to 100 was made of; `exact` where NetworkManager makes it of a whole dBm.
struct NmcliLevel {
  double rssi_dbm = 0;
  bool exact = true;
};
NmcliLevel level_of_nmcli_signal(int signal);

/// Refuses a text without a row, and with their line: rows of another number of fields, addresses, SIGNALs
/// and frequencies that are none.
PrintedLog read_nmcli_lists(const Text& text, const std::vector<std::string>& fields);

}  // namespace radioslam
