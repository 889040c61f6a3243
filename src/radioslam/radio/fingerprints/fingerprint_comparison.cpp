#include "radioslam/radio/fingerprints/fingerprint_comparison.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/radio/fingerprints/shared_access_points.hpp"

namespace radioslam {
namespace {

SharedSums product_sums(const Fingerprint& a, const Fingerprint& b) {
  SharedSums sums;
  for_each_shared(a, b, [&](const auto& x, const auto& y) {
    ++sums.shared;
    sums.sum += shifted_rss_db(x.rss_dbm) * shifted_rss_db(y.rss_dbm);
  });
  return sums;
}

SharedSums minimum_sums(const Fingerprint& a, const Fingerprint& b) {
  SharedSums sums;
  for_each_shared(a, b, [&](const auto& x, const auto& y) {
    ++sums.shared;
    sums.sum += static_cast<double>(std::min(x.rss_dbm, y.rss_dbm));
  });
  return sums;
}

SharedSums square_sums(const Fingerprint& a, const Fingerprint& b) {
  SharedSums sums;
  for_each_shared(a, b, [&](const auto& x, const auto& y) {
    const double d = static_cast<double>(x.rss_dbm) - static_cast<double>(y.rss_dbm);
    ++sums.shared;
    sums.sum += d * d;
    sums.detection2_i += static_cast<double>(x.detection_rate) * static_cast<double>(x.detection_rate);
    sums.detection2_j += static_cast<double>(y.detection_rate) * static_cast<double>(y.detection_rate);
  });
  return sums;
}

SharedSums shared_sums(const Fingerprint& a, const Fingerprint& b, SimilarityMeasure measure) {
  if (measure == SimilarityMeasure::kCosine) return product_sums(a, b);
  if (measure == SimilarityMeasure::kSorensen) return minimum_sums(a, b);
  return square_sums(a, b);
}

}  // namespace

FingerprintComparison::FingerprintComparison(const std::vector<Fingerprint>& fingerprints,
                                             SimilarityMeasure measure, const SimilarityParams& params)
    : measure_(measure), params_(params) {
  for (const Fingerprint& fingerprint : fingerprints) {
    fingerprints_.push_back({fingerprint, totals_of(fingerprint, measure, params)});
    for (auto& entry : fingerprints_.back().fingerprint.entries)
      entry.rss_dbm = compared_value(entry, measure, params);
  }
}

double FingerprintComparison::similarity(std::size_t i, const FingerprintComparison& others,
                                         std::size_t j) const {
  const Compared &a = fingerprints_[i], &b = others.fingerprints_[j];
  return similarity_of(shared_sums(a.fingerprint, b.fingerprint, measure_), a.totals, b.totals, measure_,
                       params_);
}

}  // namespace radioslam
