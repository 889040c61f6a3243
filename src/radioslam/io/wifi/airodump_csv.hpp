// Reads airodump-ng's tables: PREFIX-01.csv (one row per radio) or PREFIX-01.log.csv (one row per reception).
//
//   BSSID, First time seen, Last time seen, channel, Speed, Privacy, Cipher, Authentication, Power, #
//   beacons,
//     # IV, LAN IP, ID-length, ESSID, Key                        followed by a blank line and the stations
//   LocalTime,GPSTime,ESSID,BSSID,Power,Security,Latitude,Longitude,Latitude Error,Longitude Error,Type
//
// A row's time is when the radio was last seen, its power an average over the preceding seconds. Times are
// whole seconds of the recording machine's local clock (or of the day of the replay with `airodump-ng -r`);
// utc_offset_h and clock_offset_s convert them to the mission's clock. Network names are unquoted and may
// contain commas; the first table states their length, in the second the fields are counted from the end of
// the row. Power -1 means that the driver reported none. Stations are skipped. The second table has no
// channels.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {

struct AirodumpParams {
  double utc_offset_h = 0;
  double clock_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(utc_offset_h, "h", -26, 26,
                    "offset of the recording machine's local time from UTC; positive east of Greenwich");
    RADIOSLAM_FIELD(clock_offset_s, "s", -4e9, 4e9,
                    "offset added to every time, from the log's clock to the mission's");
  }
};

/// Leaves out incomplete rows and malformed addresses, times and numbers, with a warning. Refuses
/// (InputError) a text that is neither table, or of which most rows are malformed.
WifiLog read_airodump(const Text& text, const AirodumpParams& params);

}  // namespace radioslam
