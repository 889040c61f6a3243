// WiFi fingerprints: mean RSS and detection rate of the access points within a short window of scans.
// Source: Liu et al. (2020), Collaborative Radio SLAM for Multiple Robots based on WiFi Fingerprint
// Similarity, section II-B (5 s windows).
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct FingerprintParams {
  double window_s = 5;
  double window_path_m = 2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(window_s, "s", 0, 3600,
                          "duration of the window whose scans are merged into one fingerprint");
    RADIOSLAM_BASIC_FIELD(window_path_m, "m", 0, 1e6,
                          "path length of the window whose scans are merged into one fingerprint");
  }
};

/// One access point of a fingerprint.
struct FingerprintEntry {
  AccessPointIndex access_point;
  float rss_dbm = 0;         ///< mean over the scans that detected it
  float detection_rate = 0;  ///< fraction of the window's scans that detected it
};

/// Merged scans of one window.
struct Fingerprint {
  Stamp stamp;  ///< mean of the scans' stamps
  int scans = 0;
  std::vector<FingerprintEntry> entries;  ///< ordered by access point
};

/// Groups scans (in time order) into windows that start with a scan and end before `window_s` has passed.
std::vector<Fingerprint> make_fingerprints(const std::vector<WifiScan>& scans,
                                           const FingerprintParams& params);
/// As above, with windows that also end before the robot has travelled `window_path_m` by its odometry. Scans
/// not covered by the odometry are skipped.
std::vector<Fingerprint> make_fingerprints(const Robot& robot, const FingerprintParams& params);

}  // namespace radioslam
