#include "radioslam/radio/fingerprints/similarity.hpp"

#include <array>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/fingerprints/fingerprint_comparison.hpp"

namespace radioslam {
namespace {

constexpr std::array kNames = {
    std::pair{SimilarityMeasure::kCosine, std::string_view("cosine")},
    std::pair{SimilarityMeasure::kGaussian, std::string_view("gaussian")},
    std::pair{SimilarityMeasure::kDetection, std::string_view("detection")},
    std::pair{SimilarityMeasure::kProduct, std::string_view("slide")},
    std::pair{SimilarityMeasure::kGeometricMean, std::string_view("mended")},
    std::pair{SimilarityMeasure::kSorensen, std::string_view("sorensen")},
};

constexpr std::size_t kRowsPerTask = 8;

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
  return FingerprintComparison({a, b}, measure, params).similarity(0, 1);
}

std::vector<std::vector<float>> similarity_table(const std::vector<Fingerprint>& a,
                                                 const std::vector<Fingerprint>& b, SimilarityMeasure measure,
                                                 const SimilarityParams& params) {
  const FingerprintComparison rows(a, measure, params), columns(b, measure, params);
  std::vector<std::vector<float>> table(a.size(), std::vector<float>(b.size()));
  parallel_for(a.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = 0; j < b.size(); ++j)
        table[i][j] = static_cast<float>(rows.similarity(i, columns, j));
  });
  return table;
}

}  // namespace radioslam
