// From sums over the access points that two fingerprints share, and what each brings on its own, to their
// similarity. Every way of walking through pairs ends here: sums taken in the order of the access points
// give the same bytes whoever takes them.
#pragma once

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"

namespace radioslam {

/// What an absent access point stands for.
inline constexpr double kUnheardDbm = -100;

/// RSS in dB above an absent access point's, at least 0.
inline double shifted_rss_db(float rss_dbm) {
  const double shifted = static_cast<double>(rss_dbm) - kUnheardDbm;
  return shifted > 0 ? shifted : 0;
}

/// What a measure compares of an entry: g = (RSS + 100)^e for Sørensen, else the RSS in dBm.
float compared_value(const FingerprintEntry& entry, SimilarityMeasure measure,
                     const SimilarityParams& params);

/// What a fingerprint brings to every pair it is in.
struct FingerprintTotals {
  int heard = 0;                ///< L = H + M
  double total = 0;             ///< cosine: sum of f^2; Sørensen: of g; detection: of tau^2; else 0
  double least_detection2 = 0;  ///< detection: the smallest tau^2
};
FingerprintTotals totals_of(const Fingerprint& fingerprint, SimilarityMeasure measure,
                            const SimilarityParams& params);

/// Sums over the shared access points.
struct SharedSums {
  int shared = 0;  ///< H; cosine and Sørensen do without
  double sum = 0;  ///< cosine: of f_i f_j; Sørensen: of min(g_i, g_j); else of (f_i - f_j)^2, dB^2
  double detection2_i = 0, detection2_j = 0;  ///< detection: of tau_i^2 and tau_j^2
};
double similarity_of(const SharedSums& sums, const FingerprintTotals& i, const FingerprintTotals& j,
                     SimilarityMeasure measure, const SimilarityParams& params);

}  // namespace radioslam
