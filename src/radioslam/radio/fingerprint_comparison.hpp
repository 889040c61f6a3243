// Fingerprints made ready for a similarity measure once, to be compared one pair at a time: about 3 ns for
// every access point that either heard.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"
#include "radioslam/radio/similarity_sums.hpp"

namespace radioslam {

class FingerprintComparison {
 public:
  FingerprintComparison(const std::vector<Fingerprint>& fingerprints, SimilarityMeasure measure,
                        const SimilarityParams& params);

  std::size_t size() const { return fingerprints_.size(); }
  /// Of fingerprints i and j.
  double similarity(std::size_t i, std::size_t j) const { return similarity(i, *this, j); }
  /// Of fingerprint i and j of others, made ready for the same measure.
  double similarity(std::size_t i, const FingerprintComparison& others, std::size_t j) const;

 private:
  struct Compared {
    Fingerprint fingerprint;  ///< with the measure's values in place of the RSS
    FingerprintTotals totals;
  };

  SimilarityMeasure measure_;
  SimilarityParams params_;
  std::vector<Compared> fingerprints_;
};

}  // namespace radioslam
