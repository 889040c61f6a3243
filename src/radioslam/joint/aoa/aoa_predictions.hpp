// Predicted angles of arrival: compares measured angles with relative poses of known covariance.
#pragma once

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"

namespace radioslam {

/// Standard deviation of the direction to the other robot, from the relative pose's covariance.
template <class Pose>
DirectionSigma direction_sigma(const UncertainPose<Pose>& T_i_j);

/// Compares the measurement with the predicted direction from receiver to transmitter.
template <class Pose>
AoaAgreement check_angles(const UncertainPose<Pose>& T_receiver_transmitter, const AoaMeasurement& measured,
                          const Mission& mission, const AoaLikelihoodParams& params);

/// Whether both ends are robots whose odometry covers the measurement's stamp.
bool is_between_robots(const AoaMeasurement& measured, const Mission& mission);

}  // namespace radioslam
