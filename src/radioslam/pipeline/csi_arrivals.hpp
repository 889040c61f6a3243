// A direction of arrival, estimated along a robot's way, as the mission's measurement and as the run's
// result.
//
// Estimates are in the frame of the odometry, seen from the array's centre; what leaves here is of the
// body at the estimate's stamp:
//   u_body = R_frame_body^-1 (u + k (c - t_frame_body)),
// u the direction, k the wave's curvature (1/distance, 0 where it does not show), c the array's centre. A
// path has an elevation in a mission in space where the way tells it nearly as well as the azimuth; its
// sigma is then the larger of the two. A direction mirrored at the way is another path. Ghosts are none,
// but for the strongest.
#pragma once

#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/csi_tracks.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

ArrivalMeasurement measurement_of(const Mission& mission, const CsiAttempt& attempt,
                                  const ArrivalEstimate& estimate);

/// Peaks and power over azimuth, without paths.
MeasuredArrivalResult profile_of(const Mission& mission, const CsiAttempt& attempt,
                                 const ArrivalEstimate& estimate);

/// Where the estimate has the transmitter, for each profile whose robots it covers.
void add_estimated_azimuths(std::vector<MeasuredArrivalResult>& profiles,
                            const std::vector<RobotResult>& robots);

}  // namespace radioslam
