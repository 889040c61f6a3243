// Access point stage: estimates positions and path loss of a mission's access points from the readings along
// the estimated trajectories, and collects their signals over time.
#pragma once

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/access_point_fixes.hpp"
#include "radioslam/radio/fingerprints/access_points.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct AccessPointStageParams {
  bool enabled = true;
  int signals = 6;
  double min_detection = 0.5;  ///< rarer readings are biased to high power
  AccessPointParams fit;
  AccessPointFixParams known;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(enabled, "", 0, 0, "whether positions of access points are estimated");
    RADIOSLAM_FIELD(signals, "", 0, 1000,
                    "number of access points, strongest first, whose signal strength is reported over time");
    RADIOSLAM_FIELD(
        min_detection, "", 0, 1,
        "smallest detection rate of a reading within its fingerprint; higher values drop weak readings");
    AccessPointParams::visit_fields(self.fit, visit);
    AccessPointFixParams::visit_fields(self.known, visit);
  }
};

/// Estimates every access point received at enough sites by the placed robots of the first component, and
/// fills RunResult::access_points, signals and similarity_over_time with their counts. Needs the robots'
/// estimates. Uses all threads.
void add_access_points(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                       const AccessPointStageParams& params);

}  // namespace radioslam
