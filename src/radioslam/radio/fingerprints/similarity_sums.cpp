#include "radioslam/radio/fingerprints/similarity_sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radioslam {
namespace {

double cosine_of(const SharedSums& sums, const FingerprintTotals& i, const FingerprintTotals& j) {
  return sums.sum > 0 ? std::min(1.0, sums.sum / std::sqrt(i.total * j.total)) : 0;
}

double sorensen_of(const SharedSums& sums, const FingerprintTotals& i, const FingerprintTotals& j) {
  const double both = i.total + j.total;
  return both > 0 ? 2 * sums.sum / both : 0;
}

/// Sum of tau^2 over the unshared access points.
double alone_detection2(const SharedSums& sums, const FingerprintTotals& i, const FingerprintTotals& j) {
  return (i.total - sums.detection2_i) + (j.total - sums.detection2_j);
}

double squared(double x) { return x * x; }

void add_detections(const Fingerprint& fingerprint, FingerprintTotals& totals) {
  double least2 = std::numeric_limits<double>::infinity();
  for (const auto& entry : fingerprint.entries) {
    const double detection2 = squared(static_cast<double>(entry.detection_rate));
    totals.total += detection2;
    least2 = std::min(least2, detection2);
  }
  totals.min_detection2 = fingerprint.entries.empty() ? 0 : least2;
}

}  // namespace

float compared_value(const FingerprintEntry& entry, SimilarityMeasure measure,
                     const SimilarityParams& params) {
  if (measure != SimilarityMeasure::kSorensen) return entry.rss_dbm;
  return static_cast<float>(std::pow(shifted_rss_db(entry.rss_dbm), params.sorensen_exponent));
}

FingerprintTotals totals_of(const Fingerprint& fingerprint, SimilarityMeasure measure,
                            const SimilarityParams& params) {
  FingerprintTotals totals{static_cast<int>(fingerprint.entries.size()), 0, 0};
  if (measure == SimilarityMeasure::kDetection) add_detections(fingerprint, totals);
  for (const auto& entry : fingerprint.entries) {
    if (measure == SimilarityMeasure::kCosine) totals.total += squared(shifted_rss_db(entry.rss_dbm));
    if (measure == SimilarityMeasure::kSorensen)
      totals.total += static_cast<double>(compared_value(entry, measure, params));
  }
  return totals;
}

double similarity_of(const SharedSums& sums, const FingerprintTotals& i, const FingerprintTotals& j,
                     SimilarityMeasure measure, const SimilarityParams& params) {
  if (measure == SimilarityMeasure::kCosine) return cosine_of(sums, i, j);
  if (measure == SimilarityMeasure::kSorensen) return sorensen_of(sums, i, j);
  if (sums.shared == 0) return 0;
  const double exponent = -sums.sum / (2 * params.sigma_rss_db * params.sigma_rss_db);
  const double root = std::exp(exponent / sums.shared);
  const int heard = i.heard + j.heard - sums.shared;
  const double overlap = static_cast<double>(sums.shared) / heard;
  switch (measure) {
    case SimilarityMeasure::kGaussian:
      return root * overlap;
    case SimilarityMeasure::kDetection:
      return root * overlap *
             std::exp(-alone_detection2(sums, i, j) / (2 * params.sigma_detection * params.sigma_detection));
    case SimilarityMeasure::kProduct:
      return std::exp(exponent) / heard;
    case SimilarityMeasure::kGeometricMean:
      return sums.shared >= params.min_shared ? root : 0;
    case SimilarityMeasure::kCosine:
    case SimilarityMeasure::kSorensen:
      break;
  }
  return 0;
}

}  // namespace radioslam
