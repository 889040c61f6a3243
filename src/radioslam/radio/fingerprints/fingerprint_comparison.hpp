// Similarity of single pairs of fingerprints, precomputed for one measure: about 3 ns per access point of
// either.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"
#include "radioslam/radio/fingerprints/similarity_sums.hpp"

namespace radioslam {

class FingerprintComparison {
 public:
  FingerprintComparison(const std::vector<Fingerprint>& fingerprints, SimilarityMeasure measure,
                        const SimilarityParams& params);

  std::size_t size() const { return fingerprints_.size(); }
  /// Similarity of fingerprints i and j.
  double similarity(std::size_t i, std::size_t j) const { return similarity(i, *this, j); }
  /// Similarity of fingerprint i with fingerprint j of `others`, which must use the same measure.
  double similarity(std::size_t i, const FingerprintComparison& others, std::size_t j) const;

 private:
  struct Compared {
    Fingerprint fingerprint;  ///< with compared_value() in place of the RSS
    FingerprintTotals totals;
  };

  SimilarityMeasure measure_;
  SimilarityParams params_;
  std::vector<Compared> fingerprints_;
};

}  // namespace radioslam
