// Coarse team alignment from WiFi fingerprints: places robots with unknown starts so that the distances
// between their rigid trajectories agree with those predicted from fingerprint similarity.
//
// Initial layouts come from classical multidimensional scaling of all fingerprints (Torgerson 1952) with
// large distances cut at several lengths, and from their mirror images; trajectories rotate but do not flip,
// so the fit distinguishes them. Each is refined by majorisation of the stress
//   sum w_ij (|x_i - x_j| - d_ij)^2,  w_ij = 1 / (sigma_0^2 + (r d_ij)^2)
// one robot at a time (SMACOF, de Leeuw 1977, with each robot's points moving rigidly), which never raises
// it. The layout of least stress is kept. Pairs of low similarity only repel: their distance is a lower
// bound.
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
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

// The team's odometry trajectories as rigid bodies whose points are the fingerprints' positions.

/// Indices of at most `most` of `count` nodes, evenly thinned.
std::vector<std::size_t> thinned_nodes(std::size_t count, int most);

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
  double sigma_m = 5;           ///< sigma_0
  double sigma_relative = 0.3;  ///< r
  double pair_weight = 0.02;    ///< below 1: pairs of one fingerprint share its error
  int min_shared = 3;
  int sweeps = 100;
  int max_nodes = 1500;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(min_similarity, "", 0.001, 0.9,
                    "similarity below which a predicted distance is only a lower bound in the layout");
    RADIOSLAM_BASIC_FIELD(sigma_m, "m", 0.1, 100,
                          "standard deviation of a predicted fingerprint distance near zero");
    RADIOSLAM_FIELD(sigma_relative, "", 0, 2,
                    "relative standard deviation of a predicted fingerprint distance at long range");
    RADIOSLAM_FIELD(pair_weight, "", 1e-4, 1,
                    "weight of one fingerprint pair relative to an independent measurement");
    RADIOSLAM_FIELD(min_shared, "", 1, 1000,
                    "number of access points that two robots must both observe to be placed together");
    RADIOSLAM_FIELD(sweeps, "", 1, 10000, "largest number of majorisation passes over the robots");
    RADIOSLAM_FIELD(max_nodes, "", 10, 20000,
                    "largest number of fingerprints in the layout; more are thinned evenly");
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
                                const Progress& progress = {});

}  // namespace radioslam
