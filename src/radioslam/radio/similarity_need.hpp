// How much of a fingerprint must be shared before a similarity can be reached, whatever the RSS: the length
// and prefix filters of a set-similarity join (Chaudhuri, Ganti and Kaushik 2006; Bayardo, Ma and Srikant
// 2007), with weights where a measure has them. With s the least similarity and P what is shared of i:
//   gaussian, detection   H >= s (H + M_i + M_j) >= s L_i
//   slide                 1 >= s (H + M_i + M_j) >= s L_i, or nothing is similar; H >= 1
//   mended                H >= minimum_shared
//   cosine                sum_P f^2 >= s^2 sum_i f^2, by Cauchy and Schwarz
//   Sørensen              2 m >= s (G_i + G_j) and G_j >= m, m <= sum_P g: sum_P g >= s / (2 - s) G_i
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"

namespace radioslam {

/// A pair can reach the similarity only if the entries that are shared weigh at least `least`.
struct SharedNeed {
  std::vector<double> weights;  ///< per entry, >= 0
  double least = 0;             ///< infinite where no fingerprint can be similar enough
};

/// `least_similarity` > 0. Rounding makes the need smaller, never larger.
SharedNeed shared_need(const Fingerprint& fingerprint, double least_similarity, SimilarityMeasure measure,
                       const SimilarityParams& params);

/// The entries (places in the fingerprint) of which a similar fingerprint hears at least one: all but the
/// commonest, which together weigh too little. Per access point, `holders` is who hears it.
std::vector<std::size_t> needed_prefix(const Fingerprint& fingerprint, const SharedNeed& need,
                                       const std::vector<std::vector<std::uint32_t>>& holders);

}  // namespace radioslam
