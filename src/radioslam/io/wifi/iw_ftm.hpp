// Reads WiFi round-trip time distances (fine time measurement, IEEE 802.11mc) from the output of
// `iw dev wlan0 measurement ftm_request` or `iw event`:
//
//   wlan0 (phy #0): Peer measurements (cookie 1):                    `iw event -t` prefixes "seconds: "
//     Peer 02:00:00:00:01:00: status=0 (SUCCESS) @8123456789 tsf=0 (final)
//       FTM                                                          or: FTM failed: NO_RESPONSE (1)
//         RTT_AVG: 26685                                             ps, round trip
//         RTT_VARIANCE: 1000000                                      ps^2
//         DIST_AVG: 4000                                             mm; with DIST_VARIANCE, mm^2
//
// with the units of nl80211 (linux/nl80211.h). Other lines are skipped. Either RTT_AVG or DIST_AVG may be
// missing. If both are present, RTT_AVG is used, because drivers report it in the correct unit, and a
// contradicting DIST_AVG is counted. The sigma is the root of the variance, limited from below: the readings
// of a burst scatter less than their mean errs. Radios nearby can have negative distances (imperfect
// calibration), which become 0.
//
// Times: @ is the time of the measurement in nanoseconds since boot (CLOCK_BOOTTIME); the seconds at the
// beginning of a line are the host's clock when the line was printed. If a log has both, the smallest
// difference between them converts boot time to host time without the printing delay. If it has only one,
// that clock is used.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

struct IwFtmParams {
  double clock_offset_s = 0;
  double nominal_sigma_m = 1;
  double min_sigma_m = 0.3;
  double max_negative_m = 5;
  double max_range_m = 1e4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(clock_offset_s, "s", -4e9, 4e9,
                    "offset added to every time, from the log's clock to the mission's");
    RADIOSLAM_FIELD(nominal_sigma_m, "m", 1e-3, 1000,
                    "standard deviation of distances reported without a variance; phones show 1 m");
    RADIOSLAM_FIELD(min_sigma_m, "m", 1e-3, 1000,
                    "lower bound on the standard deviation; bursts scatter less than their mean errs");
    RADIOSLAM_FIELD(max_negative_m, "m", 0, 1000,
                    "largest magnitude of a negative distance that is taken as 0; others are left out");
    RADIOSLAM_FIELD(max_range_m, "m", 1, 1e8, "largest plausible distance; longer ones are left out");
  }
};

/// One distance to a radio.
struct FtmRange {
  Stamp stamp;
  std::string bssid;  ///< lower case
  double range_m = 0;
  double sigma_m = 0;
};

struct IwFtmLog {
  std::vector<FtmRange> ranges;  ///< sorted by time, then in the order of the log
  std::size_t failed = 0;        ///< no answer, or an answer without a distance
  std::size_t implausible = 0;   ///< too long, or too far below zero
  std::size_t timeless = 0;      ///< without a time
  std::size_t disagreeing = 0;   ///< DIST_AVG contradicts RTT_AVG; these are included in `ranges`
  std::vector<std::string> warnings;
};

/// Leaves out results with malformed numbers and addresses or a value that appears twice, with a warning.
/// Refuses (InputError) a text without any peer's result, or of which most are malformed.
IwFtmLog read_iw_ftm(const Text& text, const IwFtmParams& params);

}  // namespace radioslam
