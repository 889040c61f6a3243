// Loop closures from pairs of similar WiFi fingerprints: predicted distances between two poses.
// Source: Liu et al. (2020), algorithm 1: within a robot if the path between them is longer than odometry can
// be trusted, between robots always; kept if the predicted distance is below nu. If a robot's start is
// unknown, close pairs alone would let the team layout fold; distant pairs, at the distances they have in the
// layout, are then added. All those of two robots share the layout's error and weigh as one measurement:
// robots that close pairs tie firmly do not feel them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/team_frame/fingerprint_layout.hpp"

namespace radioslam {

struct FingerprintClosureParams {
  double within_distance_m = 5;   ///< nu_s
  double between_distance_m = 5;  ///< nu_p
  double nearest_factor = 1.5;
  double independent_pairs = 0.5;  ///< pairs of one fingerprint share its error
  int layout_pairs = 20000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(within_distance_m, "m", 0, 1000,
                          "largest predicted distance of a fingerprint closure within a robot; higher values "
                          "keep more closures");
    RADIOSLAM_BASIC_FIELD(between_distance_m, "m", 0, 1000,
                          "largest predicted distance of a fingerprint closure between two robots; higher "
                          "values keep more closures");
    RADIOSLAM_FIELD(
        nearest_factor, "", 1, 100,
        "lower bound of both distance limits, as a multiple of the smallest distance the model predicts");
    RADIOSLAM_FIELD(independent_pairs, "", 0.01, 1e6,
                    "number of independent measurements that all pairs of one fingerprint together count as");
    RADIOSLAM_FIELD(layout_pairs, "", 0, 1e8,
                    "largest number of distant pairs that constrain robots with unknown starts; more are "
                    "thinned");
  }
};

/// Closure between two fingerprints with the distance predicted from their similarity.
struct FingerprintClosure {
  std::size_t node_i = 0, node_j = 0;  ///< RadioMeasurements::nodes, node_i < node_j
  double similarity = 0;
  PredictedDistance predicted;
  double weight = 1;          ///< fraction of an independent measurement that the pair counts as
  bool keeps_layout = false;  ///< distant pair of two robots, one of which has no known start
};

/// Similarity that every close pair reaches; nothing where no pair is close.
std::optional<double> least_near_similarity(const RadioMeasurements& radio,
                                            const FingerprintClosureParams& params);

/// Close pairs: predicted distance below nu.
std::vector<FingerprintClosure> propose_near_closures(const RadioMeasurements& radio,
                                                      double max_trusted_path_m,
                                                      const FingerprintClosureParams& params);

/// Distant pairs between robots of which at least one has no known start. `places`: of the nodes, in metres.
std::vector<FingerprintClosure> propose_layout_closures(const KnownStarts& starts,
                                                        const RadioMeasurements& radio,
                                                        const Eigen::Matrix3Xd& places,
                                                        const LayoutParams& layout,
                                                        const FingerprintClosureParams& params);

/// Close pairs, then distant pairs.
std::vector<FingerprintClosure> propose_fingerprint_closures(
    const KnownStarts& starts, const RadioMeasurements& radio, const Eigen::Matrix3Xd& places,
    double max_trusted_path_m, const LayoutParams& layout, const FingerprintClosureParams& params);

}  // namespace radioslam
