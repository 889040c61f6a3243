// What airodump-ng wrote: PREFIX-01.csv, a row per radio, or PREFIX-01.log.csv, a row whenever one was heard.
//
//   BSSID, First time seen, Last time seen, channel, Speed, Privacy, Cipher, Authentication, Power, #
//   beacons,
//     # IV, LAN IP, ID-length, ESSID, Key                             and behind a blank line the stations
//   LocalTime,GPSTime,ESSID,BSSID,Power,Security,Latitude,Longitude,Latitude Error,Longitude Error,Type
//
// A row's time is when the radio was last seen, its power the average of what was heard shortly before. These
// are whole seconds of the recording machine's local clock, or of the day of the replay with `airodump-ng
// -r`: utc_offset_h and clock_offset_s bring them to the mission's clock. Names of networks stand there
// unquoted, with commas; the first table tells their length, in the second the fields are counted from the
// row's end. Power -1 means that the driver told none. Stations are passed over, and the second table knows
// no channel.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/io/wifi_log.hpp"

namespace radioslam {

struct AirodumpParams {
  double utc_offset_h = 0;
  double clock_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"utc_offset_h", "h", -26, 26, "how far the recording machine's local time was ahead of UTC"},
          self.utc_offset_h);
    visit(
        Field{"clock_offset_s", "s", -4e9, 4e9, "added to every time: from the log's clock to the mission's"},
        self.clock_offset_s);
  }
};

/// Refuses a text that is neither table, and with their line: rows that end early, addresses, times and
/// numbers that are none.
WifiLog read_airodump(const Text& text, const AirodumpParams& params);

}  // namespace radioslam
