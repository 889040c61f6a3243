// Converts scan lists printed by tools (iw, iwlist, nmcli) to rows: assigns times to the lists and removes
// stale readings.
//
// A list is the result of one scan, whose time all its rows get. If the tool prints how long ago it received
// a radio, readings older than the previous list are stale: they were in that list already, and are left out
// or kept at the time they were received. All readings of a log's first list are kept.
//
// The time of a list can come from two clocks: an explicit one (a line in the log, the file's name, the
// command line) and the boot clock, if the tool prints such times. The explicit one takes precedence: lists
// with boot times keep their relative times and are shifted together, so that one of them has the given time.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {

struct ScanListParams {
  double clock_offset_s = 0;
  bool keep_stale = false;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(clock_offset_s, "s", -4e9, 4e9,
                    "offset added to every time, from the log's clock to the mission's");
    RADIOSLAM_FIELD(keep_stale, "", 0, 1,
                    "keep readings received before the previous scan, at the time they were received");
  }
};

/// One radio in a scan list.
struct ScanListReading {
  std::string bssid;
  double frequency_mhz = 0;        ///< 0 if unknown
  std::optional<double> rssi_dbm;  ///< absent if the tool does not report dBm
  double age_s = 0;                ///< time since it was received, when the list was printed
  std::optional<Stamp> heard;      ///< when it was received, on the boot clock
};

enum class ScanListClock { kExplicit, kBoot };

/// One scan list.
struct ScanList {
  std::size_t line = 0;        ///< line at which it begins
  std::optional<Stamp> stamp;  ///< at most kLatestTime_s
  std::vector<ScanListReading> readings;
  std::string unread_time;  ///< the line before the list, if it is a time that is not understood
  ScanListClock clock = ScanListClock::kExplicit;  ///< clock of the stamp
};

/// The scan lists of one file.
struct ScanListLog {
  std::vector<ScanList> scans;
  std::map<std::string, std::size_t> counts;
  std::vector<std::string> warnings;

  std::size_t readings() const;
};

/// Names lines that are not understood, in one warning.
class ForeignLines {
 public:
  void add(const TextLines& at);
  void conclude(const std::string& name, ScanListLog& log) const;

 private:
  std::size_t count_ = 0, first_ = 0;
  std::string shown_;
};

/// The list that begins at a line which is a time, understood or not; nothing for other lines. Times without
/// a known zone are counted, and those of which only the seconds are understood are counted and named.
std::optional<ScanList> list_at_time(const TextLines& at, ScanListLog& log, ForeignLines& foreign);

/// A time given for a log from outside: that of its first or of its last list.
struct GivenTime {
  enum class Of { kFirst, kLast };
  Stamp stamp;  ///< at most kLatestTime_s
  Of of = Of::kFirst;
};

/// Assigns times to the lists of a log. Empty lists are removed. A single list without a time gets `time`, or
/// 0. Lists with boot times are shifted to `time`; without one, a warning is added. Lists whose time is
/// missing or not understood are left out with a warning; a log in which most are is refused (InputError).
void time_scans(const Text& text, ScanListLog& log, const std::optional<GivenTime>& time);

/// The clock of a log's lists, after time_scans; all lists have the same one.
std::optional<ScanListClock> clock_of(const ScanListLog& log);

/// Merges the lists of all logs into rows.
WifiLog rows_of_scans(std::vector<ScanListLog> logs, const ScanListParams& params);

}  // namespace radioslam
