// Conversion of AoA estimates into measurements of the mission and into results of the run.
//
// Estimates are in the odometry frame, seen from the array's centre c; they are converted to the body frame
// at the estimate's stamp,
//   u_body = R_frame_body^-1 (u + k (c - t_frame_body)),
// u the direction, k the wavefront's curvature (inverse distance, 0 where unobservable). In 3D missions a
// path has an elevation where its sigma is at most twice the azimuth's; the path's sigma is then the larger
// of the two. A mirror solution becomes a path of its own. Cross terms are dropped, except the strongest
// peak.
#pragma once

#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/captures/csi_tracks.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

AoaMeasurement measurement_of(const Mission& mission, const CsiAttempt& attempt, const AoaEstimate& estimate);

/// Peaks and AoA profile in the body frame, without paths.
MeasuredAoaResult profile_of(const Mission& mission, const CsiAttempt& attempt, const AoaEstimate& estimate);

/// Adds the transmitter's azimuth by the estimated trajectories to each profile whose robots they cover.
void add_estimated_azimuths(std::vector<MeasuredAoaResult>& profiles, const std::vector<RobotResult>& robots);

}  // namespace radioslam
