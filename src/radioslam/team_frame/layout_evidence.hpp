// What a layout of robots is fitted to: distances between fingerprints, by paths through a graph of them.
//
// Edges are odometry within a robot, known positions between robots of known start, and predicted distances
// between each fingerprint and its most similar ones of other robots (Isomap, Tenenbaum et al. 2000).
// Similarity ranks near fingerprints well and far ones badly, so far distances must not come from it
// directly.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

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
  double sigma_size = 0.15;

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
    RADIOSLAM_FIELD(sigma_size, "", 0, 1, "relative standard deviation of the layout's size");
  }
};

/// Of two of a layout's nodes.
using NodeSimilarity = std::function<double(std::size_t i, std::size_t j)>;

/// What the layout is fitted to.
struct LayoutEvidence {
  Eigen::MatrixXd distances_m;  ///< nodes x nodes, for the scaling; infinite where there is none
  PairTargets targets;
};

/// By both models of distance, the medians and (where it exists) the law of decay: the medians know no far
/// distances where robots went short ways, and the law does not hold everywhere. Distances of similar nodes
/// are predicted, the others are those of paths and weigh `params.far_weight` times as much, all together.
std::vector<LayoutEvidence> gather_evidence(const RadioMeasurements& radio, const NodeSimilarity& similarity,
                                            const std::vector<RigidBody>& bodies, const LayoutParams& params);

}  // namespace radioslam
