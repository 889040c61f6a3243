// The links of the WSR data set's trials: a robot drives an arc, and the strongest direction that its radio
// measured is compared with where the transmitter stood.
//
// The error is that of the azimuth against atan2(transmitter - mean place of motion capture's rows), for
// every motion: the error of a motion's frame is in it. Wheels know no heading to begin with, and that of a
// tracking camera drifts: what is left of the error in the motion's own frame, turned onto motion capture's
// by the two trajectories' best alignment in the plane, stands beside it. A link without an estimate counts
// as one that is off by half a turn. The authors' links of the same trials are those of the same transmitter
// that start at a row of the trial's motion capture.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/wsr_results.hpp"
#include "radioslam/io/wsr_trial.hpp"
#include "radioslam/radio/arrival_estimate.hpp"

namespace radioslam {

/// One transmitter of one trial by one motion.
struct AoaLink {
  std::string trial, transmitter;
  WsrSight sight = WsrSight::kLineOfSight;
  WsrMotion motion = WsrMotion::kMotionCapture;
  double true_azimuth_rad = 0;
  std::vector<ArrivalPeak> peaks;     ///< the strongest first; none where there is no estimate
  std::vector<double> published_rad;  ///< the authors' errors of their peaks; none where not found
  std::string reason;                 ///< of no estimate
  std::vector<float> profile = {};    ///< power over azimuth from -pi, the strongest 1
  double frame_turn_rad = 0;          ///< turns the motion's frame onto motion capture's
};

/// All links of a trial, by every motion it has. `published` may be empty.
std::vector<AoaLink> measure_wsr_trial(const WsrTrial& trial, const std::vector<WsrResult>& published,
                                       const ArrivalParams& params);

/// Absolute error of a peak; half a turn where there is none.
double error_rad(const AoaLink& link, std::size_t peak = 0);

/// Of the strongest peak, in the motion's own frame.
double own_frame_error_rad(const AoaLink& link);

}  // namespace radioslam
