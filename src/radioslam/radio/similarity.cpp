#include "radioslam/radio/similarity.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/shared_access_points.hpp"
#include "radioslam/radio/similarity_sums.hpp"

namespace radioslam {
namespace {

constexpr std::array kNames = {
    std::pair{SimilarityMeasure::kCosine, std::string_view("cosine")},
    std::pair{SimilarityMeasure::kGaussian, std::string_view("gaussian")},
    std::pair{SimilarityMeasure::kDetection, std::string_view("detection")},
    std::pair{SimilarityMeasure::kSlide, std::string_view("slide")},
    std::pair{SimilarityMeasure::kMended, std::string_view("mended")},
    std::pair{SimilarityMeasure::kSorensen, std::string_view("sorensen")},
};

constexpr std::size_t kRowsPerTask = 8;

/// A fingerprint as a measure compares it: its values in place of the RSS, and its totals, taken once.
struct ComparedFingerprint {
  Fingerprint fingerprint;
  FingerprintTotals totals;
};

ComparedFingerprint compared(Fingerprint fingerprint, SimilarityMeasure measure,
                             const SimilarityParams& params) {
  const FingerprintTotals totals = totals_of(fingerprint, measure, params);
  for (auto& entry : fingerprint.entries) entry.rss_dbm = compared_value(entry, measure, params);
  return {std::move(fingerprint), totals};
}

std::vector<ComparedFingerprint> compared(const std::vector<Fingerprint>& fingerprints,
                                          SimilarityMeasure measure, const SimilarityParams& params) {
  std::vector<ComparedFingerprint> result;
  for (const auto& fingerprint : fingerprints) result.push_back(compared(fingerprint, measure, params));
  return result;
}

SharedSums product_sums(const Fingerprint& a, const Fingerprint& b) {
  SharedSums sums;
  walk_shared(a, b, [&](const auto& x, const auto& y) {
    ++sums.shared;
    sums.sum += shifted_rss_db(x.rss_dbm) * shifted_rss_db(y.rss_dbm);
  });
  return sums;
}

SharedSums minimum_sums(const Fingerprint& a, const Fingerprint& b) {
  SharedSums sums;
  walk_shared(a, b, [&](const auto& x, const auto& y) {
    ++sums.shared;
    sums.sum += static_cast<double>(std::min(x.rss_dbm, y.rss_dbm));
  });
  return sums;
}

SharedSums square_sums(const Fingerprint& a, const Fingerprint& b) {
  SharedSums sums;
  walk_shared(a, b, [&](const auto& x, const auto& y) {
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

double similarity_of_compared(const ComparedFingerprint& a, const ComparedFingerprint& b,
                              SimilarityMeasure measure, const SimilarityParams& params) {
  return similarity_of(shared_sums(a.fingerprint, b.fingerprint, measure), a.totals, b.totals, measure,
                       params);
}

}  // namespace

std::string_view to_string(SimilarityMeasure measure) {
  for (const auto& [value, name] : kNames)
    if (value == measure) return name;
  return "";
}

std::optional<SimilarityMeasure> similarity_measure(std::string_view name) {
  for (const auto& [value, known] : kNames)
    if (known == name) return value;
  return std::nullopt;
}

double similarity(const Fingerprint& a, const Fingerprint& b, SimilarityMeasure measure,
                  const SimilarityParams& params) {
  return similarity_of_compared(compared(a, measure, params), compared(b, measure, params), measure, params);
}

std::vector<std::vector<float>> similarity_table(const std::vector<Fingerprint>& a,
                                                 const std::vector<Fingerprint>& b, SimilarityMeasure measure,
                                                 const SimilarityParams& params) {
  const auto rows = compared(a, measure, params), columns = compared(b, measure, params);
  std::vector<std::vector<float>> table(a.size(), std::vector<float>(b.size()));
  parallel_for(a.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = 0; j < b.size(); ++j)
        table[i][j] = static_cast<float>(similarity_of_compared(rows[i], columns[j], measure, params));
  });
  return table;
}

}  // namespace radioslam
