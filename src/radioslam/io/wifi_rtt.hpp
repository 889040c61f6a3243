// Walks of two phones that measured WiFi round-trip times to six access points and to each other
// (haiyaoyu/RTT-Indoor-localization-data-set), as missions of the robots M1 and M2:
//
//   <n>13.csv, <n>24.csv   M1 Time Stamp (ms),AP1 True Distance (m),AP1 RTT Distance (m),AP1 RTT std (m),
//                          AP1 RSS (dBm),AP2 ...,<motion>,M1 Ground Truth      "[22.995, 11.15]", metres
//   rtt-log-*.csv          Time Stamp (ms),M1-M2 RTT Distance (m),RTT std (m),RSS (dBm)
//   AP_idx_*.csv           ,x,y                                     here or in the folder above; metres
//
// SOURCE is the folder of one walk. A level or a distance of 0 was not measured. Every file's time begins at
// 0, which is taken as one moment. Distances are as measured, with the bias the phones have (0.9 m in a car
// park); their sigma is the phone's spread of a few pulses, within bounds. The positions are the truth, the
// access points' ones anchors; access points are called ap1 to ap6 in wifi.csv, and no frequency is told.
// There is no odometry: the motion columns come with the ranges, 2 to 4 times a second, too rarely to count
// steps.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/io/imported_mission.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

struct WifiRttParams {
  double usual_sigma_m = 1;
  double least_sigma_m = 0.3;
  double furthest_m = 1000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"usual_sigma_m", "m", 1e-3, 1000, "of a distance that states no spread; phones show 1 m"},
          self.usual_sigma_m);
    visit(Field{"least_sigma_m", "m", 1e-3, 1000, "a stated spread below this says nothing of its mean"},
          self.least_sigma_m);
    visit(Field{"furthest_m", "m", 1, 1e8, "longer distances are left out"}, self.furthest_m);
  }
};

/// The files of one walk.
struct WifiRttFiles {
  std::vector<Text> phones;     ///< M1's, M2's, or both
  std::optional<Text> between;  ///< the ranges between them
  std::optional<Text> anchors;  ///< where the access points are
};

/// Refuses, with their line, other columns, rows that end early, numbers that are none, and times that run
/// backwards.
ImportedMission mission_of_wifi_rtt(const WifiRttFiles& files, const std::string& name,
                                    const WifiRttParams& params = {});

/// Tells the files by their headers. Refuses (InputError) a folder without a phone's file, or with two of one
/// kind.
ImportedMission import_wifi_rtt(const std::filesystem::path& source, const WifiRttParams& params = {});

}  // namespace radioslam
