// Faults of a mission that would disturb its radio links, each with the correction that would undo it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct Correction {
  Finding finding;
  std::function<void(TeamLinks&)> apply;
  /// Whether the links between two nodes are changed.
  std::function<bool(std::size_t i, std::size_t j)> concerns;
};

/// Corrections without a magnitude: mirrored or permuted coordinates, units, directions of rotation.
std::vector<Correction> discrete_corrections(const Mission& mission, const TeamLinks& team);
/// Offsets of a clock by so many seconds, of a robot's odometry or of one of the team's files.
std::vector<Correction> clock_corrections(const Mission& mission, const TeamLinks& team, double seconds);
/// Constant errors of ranges or angles, heights.
std::vector<Correction> offset_corrections(const Mission& mission, const TeamLinks& team);

}  // namespace radioslam
