// Similarity of two fingerprints from sums over their shared access points and the totals of each. Used by
// all algorithms that compare pairs: sums taken in the order of the access points give the same bytes in each
// of them.
#pragma once

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"

namespace radioslam {

/// RSS assumed for an undetected access point.
inline constexpr double kUndetected_dbm = -100;

/// RSS in dB above that of an undetected access point, at least 0.
inline double shifted_rss_db(float rss_dbm) {
  const double shifted = static_cast<double>(rss_dbm) - kUndetected_dbm;
  return shifted > 0 ? shifted : 0;
}

/// Value of an entry that a measure compares: g = (RSS + 100)^e for Sørensen, else the RSS in dBm.
float compared_value(const FingerprintEntry& entry, SimilarityMeasure measure,
                     const SimilarityParams& params);

/// Totals over all access points of one fingerprint.
struct FingerprintTotals {
  int heard = 0;              ///< L = H + M
  double total = 0;           ///< cosine: sum of f^2; Sørensen: of g; detection: of tau^2; else 0
  double min_detection2 = 0;  ///< detection: the smallest tau^2
};
FingerprintTotals totals_of(const Fingerprint& fingerprint, SimilarityMeasure measure,
                            const SimilarityParams& params);

/// Sums over the shared access points.
struct SharedSums {
  int shared = 0;  ///< H; not used by cosine and Sørensen
  double sum = 0;  ///< cosine: of f_i f_j; Sørensen: of min(g_i, g_j); else of (f_i - f_j)^2, dB^2
  double detection2_i = 0, detection2_j = 0;  ///< detection: of tau_i^2 and tau_j^2
};
double similarity_of(const SharedSums& sums, const FingerprintTotals& i, const FingerprintTotals& j,
                     SimilarityMeasure measure, const SimilarityParams& params);

}  // namespace radioslam
