// A team's estimate carried over to the graph of the same team when more has been measured.
//
// Keyframes are known by their robots and stamps. What was known before keeps its values; later keyframes
// follow by the odometry since. Nothing is estimated here.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "radioslam/joint/team_estimate.hpp"

namespace radioslam {

/// Whether these are robots of the same names, in the same order.
bool are_same_robots(const auto& a, const auto& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return x.id == y.id; });
}

/// Sets the values of `joint`, newly built, to those of the estimate before.
template <class Pose>
void carry_values(const JointGraph<Pose>& before, JointGraph<Pose>& joint);

/// The alignment before, of the robots and keyframes of `joint`, newly built. Robots and segments that are
/// new have frames of their own.
template <class Pose>
TeamAlignment<Pose> carried_alignment(const TeamEstimate<Pose>& before, const JointGraph<Pose>& joint);

/// The estimate before with the odometry and links that were measured since, at the values carried over;
/// links since are not weighed. `joint`: newly built, with nothing else. Nothing if there are other robots,
/// or keyframes that were known are missing.
template <class Pose>
std::optional<TeamEstimate<Pose>> extended(const TeamEstimate<Pose>& before, JointGraph<Pose> joint);

/// The component of every robot, as far as it is settled: robots share a frame if they have the same relative
/// pose in alignments that are together as likely as `certainty`.
template <class Pose>
std::vector<int> settled_components(const TeamEstimate<Pose>& team, double certainty);

}  // namespace radioslam
