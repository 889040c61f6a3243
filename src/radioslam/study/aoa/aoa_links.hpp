// AoA links of the WSR data set: compares the strongest measured direction of each transmitter with its true
// position, for robots that drive an arc.
//
// The error is the azimuth's relative to atan2(transmitter - mean position by motion capture), for every
// motion, and includes the error of the motion's frame: wheel odometry has no initial heading, and that of a
// tracking camera drifts. The error in the motion's own frame, rotated to motion capture's by the best planar
// alignment of the two trajectories, is reported separately. A link without an estimate counts as an error of
// 180 degrees. The authors' links of the same trials are those of the same transmitter that start at a motion
// capture position of the trial.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/datasets/wsr_results.hpp"
#include "radioslam/io/datasets/wsr_trial.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"

namespace radioslam {

/// One transmitter of one trial, by one motion.
struct AoaLink {
  std::string trial, transmitter;
  WsrSight sight = WsrSight::kLineOfSight;
  WsrMotion motion = WsrMotion::kMotionCapture;
  double true_azimuth_rad = 0;
  std::vector<AoaPeak> peaks;         ///< strongest first; empty without an estimate
  std::vector<double> published_rad;  ///< the authors' errors of their peaks; empty if not found
  std::string reason;                 ///< why there is no estimate
  std::vector<float> profile = {};    ///< power over azimuth from -pi; maximum 1
  double frame_turn_rad = 0;          ///< rotates the motion's frame to motion capture's
};

/// All links of a trial, by each of its motions. `published` may be empty.
std::vector<AoaLink> measure_wsr_trial(const WsrTrial& trial, const std::vector<WsrResult>& published,
                                       const AoaParams& params);

/// Absolute error of a peak; pi if it does not exist.
double error_rad(const AoaLink& link, std::size_t peak = 0);

/// Error of the strongest peak in the motion's own frame.
double own_frame_error_rad(const AoaLink& link);

}  // namespace radioslam
