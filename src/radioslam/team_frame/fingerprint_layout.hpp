// Coarse team alignment from WiFi fingerprints: places robots with unknown starts so that the distances
// between their rigid trajectories agree with those predicted from fingerprint similarity.
//
// Distances follow paths through a graph: odometry within a robot, predicted distances to each fingerprint's
// most similar ones of other robots (Isomap, Tenenbaum et al. 2000). Similarity ranks near fingerprints well
// and far ones badly, so far distances must not come from similarity directly. Classical multidimensional
// scaling (Torgerson 1952) of these distances and its mirror image are the initial layouts, by each of two
// models of distance; trajectories rotate but do not flip, which distinguishes a layout from its mirror
// image. Each is fitted to all distances with Cauchy's loss and
//   sigma_ij^2 = sigma_0^2 + (r d_ij)^2
// one robot at a time (rigid_layout.hpp), then to the team's radio field (field_refinement.hpp), which
// decides between them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/team_frame/field_refinement.hpp"
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

// Classical multidimensional scaling: points of the plane from their mutual distances (Torgerson 1952).

/// 2 x n coordinates whose distances approximate the symmetric n x n `distances_m`, centred at the origin.
/// Rotation and handedness are arbitrary but deterministic.
Eigen::Matrix2Xd classical_scaling(const Eigen::MatrixXd& distances_m);

struct LayoutParams {
  double min_similarity = 0.1;
  double sigma_m = 3;           ///< sigma_0
  double sigma_relative = 0.3;  ///< r
  int neighbours = 20;
  double far_weight = 0.6;
  double pair_weight = 0.15;  ///< below 1: pairs of one fingerprint share its error
  int min_shared = 3;
  int rounds = 40;
  int max_nodes = 500;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(min_similarity, "", 0.001, 0.9,
                    "similarity above which fingerprints of two robots have something in common");
    RADIOSLAM_BASIC_FIELD(sigma_m, "m", 0.1, 100,
                          "standard deviation of a predicted fingerprint distance near zero");
    RADIOSLAM_FIELD(sigma_relative, "", 0, 2,
                    "relative standard deviation of a predicted fingerprint distance at long range");
    RADIOSLAM_FIELD(neighbours, "", 1, 1000,
                    "most similar fingerprints of other robots whose predicted distances make the layout");
    RADIOSLAM_FIELD(far_weight, "", 0, 100,
                    "weight of all other distances between robots together, relative to those");
    RADIOSLAM_FIELD(pair_weight, "", 1e-4, 1,
                    "weight of one fingerprint pair relative to an independent measurement");
    RADIOSLAM_FIELD(min_shared, "", 1, 1000,
                    "number of access points that two robots must both observe to be placed together");
    RADIOSLAM_FIELD(rounds, "", 1, 10000, "largest number of reweightings of the layout");
    RADIOSLAM_FIELD(
        max_nodes, "", 10, 20000,
        "largest number of fingerprints in the layout and its radio field; more are thinned robot "
        "by robot (time grows with the cube)");
  }
};

/// Start pose of every robot, seen from above, and its component: the robots that share its frame.
struct TeamFrame {
  std::vector<SE2> T_team_start;  ///< per robot
  std::vector<int> component;     ///< per robot; 0 is the first robot's
  std::vector<bool> placed;       ///< false: neither radio nor an initial pose connects it to other robots
};

/// Robots with a known start keep it; the others are placed relative to them, or to the first robot.
TeamFrame align_by_fingerprints(const Mission& mission, const KnownStarts& starts,
                                const RadioMeasurements& radio, const LayoutParams& params,
                                const FieldParams& field, const Progress& progress = {});

}  // namespace radioslam
