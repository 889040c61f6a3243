// Parameters of the consistency test of a run: by the covariances of odometry and matches, or as DiSCo-SLAM's
// code has it (Huang et al., RA-L 2022), for comparison. That one has unit weights, sqrt(xi^T xi) with xi of
// pairwise.hpp, and begins at a number of matches between two robots.
#pragma once

#include <cstddef>
#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/consistency/pairwise.hpp"

namespace radioslam {

struct ConsistencyParams {
  std::string covariance = "odometry";
  double threshold = 100;  ///< of identity: m and rad
  int min_matches = 5;     ///< of identity

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(covariance, "", 0, 0,
                    "weighting of two matches' error in the consistency test; odometry: covariances; "
                    "identity: none, as DiSCo-SLAM, except in groups judged by radio",
                    "odometry|identity");
    RADIOSLAM_FIELD(
        threshold, "", 1e-6, 1e6,
        "with identity, largest norm of the error of two consistent matches, which adds metres to "
        "radians; DiSCo-SLAM: 100 or 20");
    RADIOSLAM_FIELD(min_matches, "", 1, 1e6,
                    "with identity, smallest number of matches between two robots before any is admitted; "
                    "DiSCo-SLAM: 5");
  }
};

inline bool has_unit_weights(const ConsistencyParams& params) { return params.covariance == "identity"; }

inline PairwiseParams pairwise_params(const ConsistencyParams& params) {
  PairwiseParams pairwise;
  if (has_unit_weights(params)) pairwise.max_norm = params.threshold;
  return pairwise;
}

/// Whether so many matches between two robots may be admitted.
inline bool are_enough(std::size_t matches, const ConsistencyParams& params) {
  return !has_unit_weights(params) || matches >= static_cast<std::size_t>(params.min_matches);
}

}  // namespace radioslam
