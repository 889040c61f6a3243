// RSSI offsets between the robots' devices, estimated from colocated fingerprints without known positions.
//
// Fingerprints i, j of robots a, b differ in the access points that they share by
//   d_k = f_ik - f_jk = o_a - o_b + differences of position, shadowing and fading,
// whose variance is independent of the offsets o. Colocated pairs are therefore found as mutual best matches
// by the Gaussian measure with the mean difference removed,
//   s_ij = exp(-var(d) / 2 sigma_r^2) H / (H + M_i + M_j).
// A pair measures d_ij, the mean of d over its most often detected and strongest access points: weak ones are
// detected only when they happen to be strong, which hides the offset. The offsets minimise
//   sum over pairs of Huber((d_ij - o_a + o_b) / s) + sum over robots of o^2 / 2 sigma_o^2,
// s from the median residual; they sum to zero over connected robots. As the pairs of one fingerprint share
// its error, m pairs per fingerprint scale covariances by (1 + m) / 2. Offsets are applied only if jointly
// significant by a chi-squared test. Large offsets are underestimated by 10 to 20 %, since a less sensitive
// device detects fewer access points. Without scans, with one robot, or without shared access points all
// offsets are zero. Units: dB. Cost: shared access points of all pairs of fingerprints of different robots;
// uses all threads.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct RssiOffsetParams {
  double prior_sigma_db = 3;
  double min_sigma_db = 0.3;
  double false_alarm_probability = 0.0027;
  int strongest_shared = 7;
  double min_similarity = 0.4;
  int min_pairs = 8;
  int max_iterations = 30;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"rssi_offset_sigma_db", "dB", 0, 100,
                "prior standard deviation of the RSSI offset of a device; 0 disables the estimation; phones "
                "differ by 2-6 dB"}
              .basic(),
          self.prior_sigma_db);
    visit(Field{"rssi_offset_min_sigma_db", "dB", 0, 100,
                "lower bound on the standard deviation of an RSSI offset: effect of changing bodies and "
                "mountings"},
          self.min_sigma_db);
    visit(Field{"rssi_offset_false_alarm_probability", "", 1e-9, 0.5,
                "probability of correcting RSSI offsets where there are none; 0.0027 is three sigma"},
          self.false_alarm_probability);
    visit(Field{"rssi_offset_strongest_shared", "", 1, 1000,
                "number of strongest shared access points that a pair is compared by; weaker ones hide the "
                "offset"},
          self.strongest_shared);
    visit(Field{"rssi_offset_min_similarity", "", 0, 1,
                "smallest similarity of a pair used for RSSI offsets; below it positions differ more than "
                "devices"},
          self.min_similarity);
    visit(Field{"rssi_offset_min_pairs", "", 2, 1e6,
                "smallest number of pairs of two robots; fewer may all come from one atypical place"},
          self.min_pairs);
    visit(Field{"rssi_offset_max_iterations", "", 1, 1000,
                "number of iterations of the robust estimation of RSSI offsets"},
          self.max_iterations);
  }
};

/// RSSI offset of a robot's device from the team's mean.
struct RssiOffsetEstimate {
  double offset_db = 0;
  double sigma_db = 0;    ///< of the estimate, whether applied or not; the prior's where not observed
  std::size_t pairs = 0;  ///< colocated pairs of fingerprints used
  RssiOffsetStatus status = RssiOffsetStatus::kNotSought;
};

struct RssiOffsets {
  std::vector<RssiOffsetEstimate> robots;  ///< all zero unless significant
  bool shown = false;
};

/// `robots` holds the fingerprints of each robot; `similarity` gives sigma_rss_db and min_shared.
RssiOffsets estimate_rssi_offsets(const std::vector<std::vector<Fingerprint>>& robots,
                                  const SimilarityParams& similarity, const RssiOffsetParams& params);

/// Subtracts a device's RSSI offset from its fingerprints.
void remove_rssi_offset(std::vector<Fingerprint>& fingerprints, double offset_db);

}  // namespace radioslam
