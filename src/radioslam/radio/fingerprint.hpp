// What the air was like at a place: the access points heard in a short window of scans.
// Source: Liu et al., Collaborative Radio SLAM for Multiple Robots based on WiFi Fingerprint Similarity,
// section II-B (5 s windows, mean RSS and detection rate).
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct FingerprintParams {
  double window_s = 5;      ///< length of a window
  double window_way_m = 2;  ///< a window also ends after this way: a fingerprint is of one place

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"window_s", "s", 0, 3600, "scans closer than this in time make one fingerprint"},
          self.window_s);
    visit(Field{"window_way_m", "m", 0, 1e6, "and closer than this along the robot's way"},
          self.window_way_m);
  }
};

/// One access point of a fingerprint.
struct FingerprintEntry {
  AccessPointIndex access_point;
  float rss_dbm = 0;         ///< mean over the scans that heard it
  float detection_rate = 0;  ///< scans that heard it / scans in the window
};

/// A window of scans.
struct Fingerprint {
  Stamp stamp;  ///< mean of the scans' stamps
  int scans = 0;
  std::vector<FingerprintEntry> entries;  ///< ordered by access point
};

/// Groups scans (in time order) into windows that start with a scan and end before `window_s` has passed.
std::vector<Fingerprint> make_fingerprints(const std::vector<WifiScan>& scans,
                                           const FingerprintParams& params);
/// The same, and a window ends before the robot has walked `window_way_m` by its odometry. Scans outside
/// the odometry's time are left out.
std::vector<Fingerprint> make_fingerprints(const Robot& robot, const FingerprintParams& params);

}  // namespace radioslam
