// The angles of arrival between robots, against relative poses that know their own uncertainty.
#pragma once

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/arrival_likelihood.hpp"

namespace radioslam {

/// How well the relative pose tells in which direction the other robot is.
template <class Pose>
DirectionSigma direction_sigma(const UncertainPose<Pose>& T_i_j);

/// What the measurement says of where the transmitting robot is seen from the receiving one.
template <class Pose>
AngleCheck check_angles(const UncertainPose<Pose>& T_receiver_transmitter, const ArrivalMeasurement& measured,
                        const Mission& mission, const ArrivalLikelihoodParams& params);

/// Both ends are robots whose odometry covers the measurement's time.
bool is_between_robots(const ArrivalMeasurement& measured, const Mission& mission);

}  // namespace radioslam
