// Imports the WiFi RTT data set (haiyaoyu/RTT-Indoor-localization-data-set): walks of two phones that
// measured WiFi round-trip times to six access points and to each other, as missions of the robots M1 and M2:
//
//   <n>13.csv, <n>24.csv   M1 Time Stamp (ms),AP1 True Distance (m),AP1 RTT Distance (m),AP1 RTT std (m),
//                          AP1 RSS (dBm),AP2 ...,<motion>,M1 Ground Truth      "[22.995, 11.15]", metres
//   rtt-log-*.csv          Time Stamp (ms),M1-M2 RTT Distance (m),RTT std (m),RSS (dBm)
//   AP_idx_*.csv           ,x,y                                     here or in the folder above; metres
//
// SOURCE is the folder of one walk. A level or distance of 0 means that it was not measured. The times of
// each file begin at 0, assumed to be the same instant. Distances are not corrected for the bias of the
// phones (0.9 m in a car park); their sigma is the spread of a few pulses as reported by the phone, limited
// from below. The positions are the ground truth, those of the access points are anchors. Access points are
// called ap1 to ap6 in wifi.csv and have no frequency. There is no odometry: the motion columns have only 2
// to 4 samples per second, too few for counting steps.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

struct WifiRttParams {
  double nominal_sigma_m = 1;
  double min_sigma_m = 0.3;
  double max_range_m = 1000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(nominal_sigma_m, "m", 1e-3, 1000,
                    "standard deviation of distances reported without a spread; phones show 1 m");
    RADIOSLAM_FIELD(min_sigma_m, "m", 1e-3, 1000,
                    "lower bound on the standard deviation; pulses scatter less than their mean errs");
    RADIOSLAM_FIELD(max_range_m, "m", 1, 1e8, "largest plausible distance; longer ones are left out");
  }
};

/// The files of one walk.
struct WifiRttFiles {
  std::vector<Text> phones;     ///< M1's, M2's, or both
  std::optional<Text> between;  ///< the ranges between them
  std::optional<Text> anchors;  ///< where the access points are
};

/// Leaves out incomplete rows and malformed numbers, with a warning. Refuses (InputError) other columns, a
/// file of which most rows are bad, and times of which more than a tenth are out of order by more than a
/// second.
ImportedMission mission_of_wifi_rtt(const WifiRttFiles& files, const std::string& name,
                                    const WifiRttParams& params = {});

/// Recognises the files by their headers. Refuses (InputError) a folder without a phone's file, or with two
/// files of the same kind.
ImportedMission import_wifi_rtt(const std::filesystem::path& source, const WifiRttParams& params = {});

}  // namespace radioslam
