// Simulated phones that scan for WiFi access points on a driving robot.
//
// A reading is round(mean power + phone's offset + fading) in whole dBm. A phone reports it with probability
// 1 / (1 + exp((threshold - power) / softness)), so that weak access points appear in some scans only, and
// never below its floor. Each phone has its own start time, offset in dB and jitter; all stamps are whole
// milliseconds, and no two scans of a robot have the same stamp. Scans without readings are not recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/sim/sensors/transmitters.hpp"

namespace radioslam {

/// Number and reception of a robot's phones.
struct PhoneParams {
  int phones = 5;
  double scan_rate_hz = 0.5;
  double scan_jitter_s = 0.05;
  double missed_scan_ratio = 0.03;
  double sigma_phone_offset_db = 1;
  double sigma_fading_db = 3;
  double threshold_dbm = -83;
  double threshold_softness_db = 2;
  double floor_dbm = -97;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(phones, "", 1, 100, "number of phones per robot; five in Liu et al.");
    RADIOSLAM_BASIC_FIELD(scan_rate_hz, "Hz", 0.001, 10, "scans per second and phone; 0.5 in Liu et al.");
    RADIOSLAM_FIELD(scan_jitter_s, "s", 0, 10, "largest delay of a scan after its scheduled time");
    RADIOSLAM_BASIC_FIELD(missed_scan_ratio, "", 0, 1, "ratio of scans that fail as a whole");
    RADIOSLAM_FIELD(sigma_phone_offset_db, "dB", 0, 30,
                    "standard deviation of the constant RSSI offset of phones");
    RADIOSLAM_BASIC_FIELD(sigma_fading_db, "dB", 0, 30,
                          "standard deviation of fast fading, independent for each reading");
    RADIOSLAM_BASIC_FIELD(threshold_dbm, "dBm", -300, 0, "power that is detected in half of the scans");
    RADIOSLAM_FIELD(threshold_softness_db, "dB", 0.01, 30, "width of the logistic detection threshold");
    RADIOSLAM_FIELD(floor_dbm, "dBm", -300, 0, "weakest power that a phone reports");
  }
};

/// T_floor_body of a robot at any time of its drive, in seconds.
using PoseAtTime = std::function<SE2(double)>;

/// The scans of one robot's phones during [begin_s, end_s], in temporal order.
std::vector<WifiScan> simulate_scans(const PoseAtTime& pose_at, double begin_s, double end_s,
                                     const std::vector<Transmitter>& transmitters, double phone_height_m,
                                     const PhoneParams& params, const Rng& rng);

}  // namespace radioslam
