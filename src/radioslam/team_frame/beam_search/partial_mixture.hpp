// The mixture likelihood of a team whose segments are placed only in part: measurements within a component,
// at given values, with all other segments fixed.
#pragma once

#include <vector>

#include "radioslam/team_frame/beam_search/team_values.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

/// The connected measurements as a mixture, at the values of `at`. Segments without a component are fixed.
template <class Pose>
MixtureGraph<Pose> partial_mixture(const ConnectedTeam<Pose>& connected, const TeamComponents& components,
                                   const TeamValues<Pose>& at, const MixtureParams& params);

/// The inflation of the connected measurements, from that of all measurements of the team.
template <class Pose>
VarianceInflation inflation_of_connected(const VarianceInflation& all, const ConnectedTeam<Pose>& connected);

/// What the odometry's drift adds to the variance of every range and bearing between trajectories in one
/// frame: of positions, and of the receiver's heading, by the team's graph without these. None if no
/// covariance can be computed.
template <class Pose>
VarianceInflation inflation_by_odometry(const TeamGraph<Pose>& team);

/// Standard deviation of every pose's position; zero if no covariance can be computed.
template <class Pose>
std::vector<double> position_sigmas_m(MixtureGraph<Pose> mixture);

}  // namespace radioslam
