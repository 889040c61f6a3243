// Lists of radios as tools print them: when a list was made, what in it is new, and the rows that come of it.
//
// A list says what was heard in one scan, which gives all its rows their time; wherever the tool adds how
// long ago it heard a radio, that tells leftovers: a radio heard before the previous list was made stood in
// that list already, and is left out, or kept at the time it was heard. Of a log's first list all is kept.
//
// Two clocks may date a list: the one that whoever recorded tells of (a line in the log, the file's name, the
// call), and the one that starts with the machine, where the tool prints its times. The first goes before:
// lists dated by the second keep their distances in time and move as one to where one of them is told to be.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/io/wifi_log.hpp"

namespace radioslam {

struct PrintedScanParams {
  double clock_offset_s = 0;
  bool keep_stale = false;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(
        Field{"clock_offset_s", "s", -4e9, 4e9, "added to every time: from the log's clock to the mission's"},
        self.clock_offset_s);
    visit(Field{"keep_stale", "", 0, 1, "keep what was heard before the previous scan, at that earlier time"},
          self.keep_stale);
  }
};

/// One radio in a list.
struct PrintedReading {
  std::string bssid;
  double frequency_mhz = 0;        ///< 0 where it is not known
  std::optional<double> rssi_dbm;  ///< absent where the tool says no dBm
  double age_s = 0;                ///< how long ago it was heard, when the list was made
  std::optional<Stamp> heard;      ///< when it was heard, on the clock that starts with the machine
};

enum class PrintedClock { kTold, kBoot };

/// One list.
struct PrintedScan {
  std::size_t line = 0;        ///< where it begins
  std::optional<Stamp> stamp;  ///< at most kLatestTime_s
  std::vector<PrintedReading> readings;
  PrintedClock clock = PrintedClock::kTold;  ///< of the stamp
};

/// What a reader found in one file.
struct PrintedLog {
  std::vector<PrintedScan> scans;
  std::map<std::string, std::size_t> counts;
  std::vector<std::string> warnings;
};

/// A log's time that does not stand in it: that of its first list, or of its last one.
struct ToldTime {
  enum class Of { kFirst, kLast };
  Stamp stamp;  ///< at most kLatestTime_s
  Of of = Of::kFirst;
};

/// Leaves out lists of nothing, and gives the one list of a log without times that of `time`, or 0; lists
/// dated by the boot clock move to `time`, and a note says so where there is none. Refuses, with its line, a
/// list without a time beside others.
void time_scans(const Text& text, PrintedLog& log, const std::optional<ToldTime>& time);

/// Of a log's lists, once they have times. All have one clock.
std::optional<PrintedClock> clock_of(const PrintedLog& log);

/// The rows of all logs' lists together.
WifiLog rows_of_scans(std::vector<PrintedLog> logs, const PrintedScanParams& params);

}  // namespace radioslam
