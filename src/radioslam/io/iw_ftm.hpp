// Distances to WiFi radios by round-trip time, as `iw dev wlan0 measurement ftm_request` or `iw event` print
// them (fine time measurement, IEEE 802.11mc):
//
//   wlan0 (phy #0): Peer measurements (cookie 1):                    `iw event -t` puts "seconds: " in front
//     Peer 02:00:00:00:01:00: status=0 (SUCCESS) @8123456789 tsf=0 (final)
//       FTM                                                          or: FTM failed: NO_RESPONSE (1)
//         RTT_AVG: 26685                                             ps, there and back
//         RTT_VARIANCE: 1000000                                      ps^2
//         DIST_AVG: 4000                                             mm; with DIST_VARIANCE, mm^2
//
// as nl80211 has it (linux/nl80211.h). Other lines are passed over. Of RTT_AVG and DIST_AVG either may be
// missing; where both stand, RTT_AVG counts, whose unit no driver gets wrong, and a DIST_AVG that disagrees
// is reported. The sigma is the root of the variance, within bounds: a burst spreads less than its mean errs.
// Near radios come out below zero by what their calibration lacks: as 0, which a mission can hold.
//
// Times: @ counts nanoseconds since boot (CLOCK_BOOTTIME) when it was measured, the seconds in front are the
// host's clock when it was printed. Where a log has both, the least difference between them makes host time
// of the former, without the delay of printing. Where it has one, that is the clock.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

struct IwFtmParams {
  double clock_offset_s = 0;
  double usual_sigma_m = 1;
  double least_sigma_m = 0.3;
  double most_negative_m = 5;
  double furthest_m = 1e4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(
        Field{"clock_offset_s", "s", -4e9, 4e9, "added to every time: from the log's clock to the mission's"},
        self.clock_offset_s);
    visit(Field{"usual_sigma_m", "m", 1e-3, 1000, "of a distance that states no variance; phones show 1 m"},
          self.usual_sigma_m);
    visit(Field{"least_sigma_m", "m", 1e-3, 1000, "a stated variance below this says nothing of its mean"},
          self.least_sigma_m);
    visit(Field{"most_negative_m", "m", 0, 1000, "distances down to so far below zero count as 0"},
          self.most_negative_m);
    visit(Field{"furthest_m", "m", 1, 1e8, "longer distances are left out"}, self.furthest_m);
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
  std::vector<FtmRange> ranges;  ///< in the order of time, then as printed
  std::size_t failed = 0;        ///< the radio did not answer, or the answer holds no distance
  std::size_t implausible = 0;   ///< too far, or too far below zero
  std::size_t timeless = 0;      ///< without any time
  std::size_t disagreeing = 0;   ///< DIST_AVG is not the distance of RTT_AVG; among `ranges`
};

/// Refuses a text without any result of a peer, and with their line: numbers and addresses that are none, two
/// results in one.
IwFtmLog read_iw_ftm(const Text& text, const IwFtmParams& params);

}  // namespace radioslam
