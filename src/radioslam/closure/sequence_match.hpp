// How two stretches of way lie to each other, from the similarities of their fingerprints alone.
//
// 1. Matches. Every fingerprint of one window is matched to the similarity-weighted mean of the places of
//    its k most similar ones in the other, x* = sum s x / sum s, in both directions. The rigid transform that
//    best carries places onto their matches (Umeyama, without scale) is where the seed stops. A mean lies
//    within the other window, though: matches are drawn towards its middle.
// 2. Estimate. From there on, the pose most likely under the distances that all pairs of the two windows
//    predict (sequence_pairs.hpp), which has no such pull.
// 3. Rivals. Along a straight way fingerprints tell how far off another way is, not on which side. The same
//    estimate is sought from the first one's reflections about either window's long axis, and from three
//    other headings.
// Source: Dammalapati and Hajdarpasic, WiFi Assisted Loop Closure Detection; 2 and 3 are ours.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/sequence_pairs.hpp"

namespace radioslam {

struct SequenceMatchParams {
  int nearest = 3;                 ///< k
  double loss_sigmas = 2;          ///< scale of the Cauchy loss on predicted distances
  double largest_residual_m = 3;   ///< mean distance of a place from its match
  double rival_distance_m = 3;     ///< a pose further off than this is another one
  double rival_angle_rad = 0.35;   ///< or turned by more than this, 20 degrees
  double least_rival_margin = 10;  ///< in independent cost: less, and the rival may be the true one
  double independent_share = 0.2;  ///< of a window's pairs: the evidence that they are together

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"nearest", "", 1, 100, "most similar fingerprints that make a match; the seed's k, ours"},
          self.nearest);
    visit(Field{"loss_sigmas", "", 0.1, 1e6, "scale of the Cauchy loss on predicted distances; ours"},
          self.loss_sigmas);
    visit(Field{"largest_residual_m", "m", 0, 1000,
                "mean distance of places from their matches, at most; the seed's"},
          self.largest_residual_m);
    visit(Field{"rival_distance_m", "m", 0.01, 1000, "a pose further off than this is another one; ours"},
          self.rival_distance_m);
    visit(Field{"rival_angle_rad", "rad", 0.01, 7, "or turned by more than this; ours, 20 degrees"},
          self.rival_angle_rad);
    visit(Field{"least_rival_margin", "", 0, 1e6,
                "a rival whose cost is within this leaves the closure open; chi-squared of 3 at 2 %, ours"},
          self.least_rival_margin);
    visit(Field{"independent_share", "", 1e-3, 1,
                "share of two windows' pairs that counts as independent evidence; ours, by NEES"},
          self.independent_share);
  }
};

enum class SequenceVerdict {
  kAccepted,
  kTooFewPlaces,  ///< fewer than three places of a window are like any of the other one's
  kNoDistances,   ///< the model predicts none
  kResidual,      ///< places lie too far from their matches
  kAmbiguous,     ///< another pose fits as well
  kUncertain,     ///< so straight or so coarse that the pose is loose
  kBeside,        ///< a better closure of the same two stretches stands
};

/// Where window i lies in window j.
struct SequenceFit {
  SequenceVerdict verdict = SequenceVerdict::kTooFewPlaces;
  double residual_m = 0;  ///< mean distance of a place of i from its match
  SE2 T_j_i;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_j_i Exp(xi); of accepted ones
};

SequenceFit match_windows(const RadioMeasurements& radio, const SequenceWindow& i, const SequenceWindow& j,
                          const SequenceMatchParams& params);

}  // namespace radioslam
