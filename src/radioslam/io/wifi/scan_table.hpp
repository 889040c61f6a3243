// Reads the tables of WiFi scans that apps for phones export: a row per access point, with a time, an address
// and a level.
//
//   MAC,SSID,AuthMode,FirstSeen,Channel,Frequency,RSSI,CurrentLatitude,...,Type     WiGLE
//   time,seconds_elapsed,ssid,bssid,frequency,level,capabilities                    Sensor Logger
//   deviceTime,...,bssid,ssid,channel,frequencyMhz,signalStrength,...               Network Survey
//   timestamp,bssid,ssid,frequency,level                                            many others
//
// Columns are recognised by their names (named_columns.hpp): a time; bssid, or else mac or address; rssi,
// level, signal, ...; a frequency in Hz to GHz, or else a channel, or neither. WiGLE's line before the header
// is skipped. Rows within scan_s of the first of a scan belong to it and get its time, unless they repeat one
// of its addresses: apps that give every row the time at which its access point was received would otherwise
// have scans of one row each. Names of networks are skipped.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {

struct ScanTableParams {
  double scan_s = 1;
  double clock_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(scan_s, "s", 0, 3600, "longest duration of one scan whose rows have times of their own");
    RADIOSLAM_FIELD(clock_offset_s, "s", -4e9, 4e9,
                    "offset added to every time of a scan, from its table's clock to the mission's");
  }
};

/// Whether the text's header has the columns of such a table.
bool is_scan_table(const Text& text);

/// Leaves out rows with a malformed time, address or number, with a warning; counts rows of other radios than
/// WiFi, levels that are not negative, and Android's placeholder for addresses. Refuses (InputError) a text
/// that is no such table, or of which most rows are malformed.
WifiLog read_scan_table(const Text& text, const ScanTableParams& params);

}  // namespace radioslam
