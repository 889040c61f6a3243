// The access points of a mission, by what was heard along the estimate, and how it sounded over time.
#pragma once

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/access_points.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct AccessPointStageParams {
  bool enabled = true;
  int signals = 6;               ///< access points whose strength over time is told
  double least_detection = 0.5;  ///< of the scans of a fingerprint; rarer readings are the lucky strong ones
  AccessPointParams fit;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"enabled", "", 0, 0, "whether access points are placed"}, self.enabled);
    visit(Field{"signals", "", 0, 1000, "access points whose strength over time is told, the strongest"},
          self.signals);
    visit(Field{"least_detection", "", 0, 1, "share of a fingerprint's scans that heard it; ours"},
          self.least_detection);
    AccessPointParams::visit_fields(self.fit, visit);
  }
};

/// Places every access point that was heard in enough places by the placed robots of the first component, and
/// fills RunResult::access_points, signals and similarity_over_time and their counts. The robots' estimates
/// must stand. Uses all threads.
void add_access_points(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                       const AccessPointStageParams& params);

}  // namespace radioslam
