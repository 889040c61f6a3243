// Coarse team alignment from WiFi fingerprints: places robots with unknown starts so that the distances
// between their rigid trajectories agree with those predicted from fingerprint similarity.
//
// Distances follow paths through a graph of fingerprints (layout_evidence.hpp). Their scaling and its mirror
// image are the initial layouts, by each of two models of distance (scaled_layouts.hpp), fitted to all
// distances with Cauchy's loss and
//   sigma_ij^2 = sigma_0^2 + (r d_ij)^2
// one robot at a time (rigid_layout.hpp), then to the team's radio field (field_refinement.hpp), which
// decides between them. How well the layout is known: layout_uncertainty.hpp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/team_frame/field_refinement.hpp"
#include "radioslam/team_frame/layout_evidence.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

// The team's odometry trajectories as rigid bodies whose points are the fingerprints' positions.

/// About `most` of the team's fingerprints (of RadioMeasurements::nodes, increasing): every robot's if there
/// are few, else as many, evenly spaced; at least one.
std::vector<std::size_t> thinned_nodes(const RadioMeasurements& radio, int most);

/// A body per robot with its points among `nodes` (of RadioMeasurements::nodes, increasing); robots with a
/// known start are fixed there, the others are in their own start frame.
std::vector<RigidBody> fingerprint_bodies(const Mission& mission, const KnownStarts& starts,
                                          const RadioMeasurements& radio,
                                          const std::vector<std::size_t>& nodes);

/// Start pose of every robot, seen from above, and its component: the robots that share its frame.
struct TeamFrame {
  std::vector<SE2> T_team_start;  ///< per robot
  std::vector<int> component;     ///< per robot; 0 is the first robot's
  std::vector<bool> placed;       ///< false: neither radio nor an initial pose connects it to other robots
  std::vector<double> sigma_layout_m;  ///< per robot: standard deviation of its place, per axis
  std::optional<std::string> note;     ///< on other layouts that may be the true one
};

/// Robots with a known start keep it; the others are placed relative to them, or to the first robot.
TeamFrame align_by_fingerprints(const Mission& mission, const KnownStarts& starts,
                                const RadioMeasurements& radio, const LayoutParams& params,
                                const FieldParams& field, const Progress& progress = {});

}  // namespace radioslam
