// Similarity bounds: how much of a fingerprint must be shared to reach a similarity, whatever the RSS. These
// are the length and prefix filters of a set-similarity join (Chaudhuri, Ganti and Kaushik 2006; Bayardo, Ma
// and Srikant 2007), weighted where the measure has weights. With s the smallest similarity and P the shared
// entries of i:
//   gaussian, detection   H >= s (H + M_i + M_j) >= s L_i
//   slide                 1 >= s (H + M_i + M_j) >= s L_i, else no fingerprint is similar; H >= 1
//   mended                H >= min_shared
//   cosine                sum_P f^2 >= s^2 sum_i f^2, by Cauchy and Schwarz
//   Sørensen              2 m >= s (G_i + G_j) and G_j >= m, m <= sum_P g: sum_P g >= s / (2 - s) G_i
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"

namespace radioslam {

/// A pair can reach the similarity only if the weights of its shared entries sum to at least `least`.
struct SharedWeightBound {
  std::vector<double> weights;  ///< per entry, >= 0
  double least = 0;             ///< infinite where no fingerprint can reach the similarity
};

/// `min_similarity` > 0. Rounding only ever lowers the bound.
SharedWeightBound shared_weight_bound(const Fingerprint& fingerprint, double min_similarity,
                                      SimilarityMeasure measure, const SimilarityParams& params);

/// Indices of entries of which a similar fingerprint has at least one: all except the most common access
/// points, whose weights together stay below the bound. `holders` lists who detects each access point.
std::vector<std::size_t> join_prefix(const Fingerprint& fingerprint, const SharedWeightBound& need,
                                     const std::vector<std::vector<std::uint32_t>>& holders);

}  // namespace radioslam
