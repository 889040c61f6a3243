// What angles of arrival say of a relative pose between two robots.
#pragma once

#include <vector>

#include "radioslam/rendezvous/robot_interface.hpp"

namespace radioslam {

/// What angles of arrival say of a relative pose between two robots.
struct AngleEvidence {
  double log_odds = 0;  ///< against it, of a direction drawn evenly
  double scale = 1;     ///< of its information by Wang et al., eq. 7
};

struct AngleCheckParams {
  double direct_ratio = 0.95;  ///< probability that one of the arrivals is the direct one
  double threshold_rad = 0.14835298641951802;
};

/// T_i_j: the transmitter's pose in the receiver's body frame, with its standard deviations per axis; of the
/// direction that it predicts, sigma_m / distance, and sigma_rad too where the measurement was made at j.
struct PredictedPose {
  SE2 T_i_j;
  double sigma_m = 0;
  double sigma_rad = 0;  ///< 0: measured in the receiver's own frame
};

/// Log odds: a uniform direction against the one predicted,
///   -log(1 - P + 2 pi P sum_k w_k N(theta - theta_k; s_k)),
/// w_k an arrival's share of the amplitudes, s_k^2 = sigma_k^2 + variance of the prediction; the mean over
/// the packets. Scale: Wang et al., eq. 7, by the nearest arrival of the last packet. No packets: nothing is
/// said.
AngleEvidence check_angles(const PredictedPose& pose, const std::vector<std::vector<ArrivalPath>>& packets,
                           const AngleCheckParams& params);

}  // namespace radioslam
