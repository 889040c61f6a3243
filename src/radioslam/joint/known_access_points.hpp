// Known access points in a run: what their fixes (radio/fingerprints/access_point_fixes.hpp) add to the
// mission, and what of them is reported.
#pragma once

#include <optional>

#include "radioslam/joint/access_point_stage.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/access_point_fixes.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// The fixes, and the mission with them beside those that were recorded; none of it if there are none.
struct KnownAccessPoints {
  AccessPointFixes fixes;
  std::optional<Mission> mission;
};

KnownAccessPoints use_known_access_points(const Mission& mission, const RadioMeasurements& radio,
                                          const AccessPointStageParams& params);

/// Adds notes on what was used of the known access points, why the rest was not, and which of them the
/// estimated positions contradict: by more than three standard deviations and by more than 10 m, where the
/// first component is in the common frame.
void add_known_access_points(RunResult& result, const Mission& mission, const AccessPointFixes& fixes,
                             const AccessPointFixParams& params);

}  // namespace radioslam
