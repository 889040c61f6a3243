#include "radioslam/radio/similarity.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "radioslam/base/parallel.hpp"

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

constexpr double kUnheardDbm = -100;  // what an absent access point stands for
constexpr std::size_t kRowsPerTask = 8;

double shifted(float rss_dbm) { return std::max(0.0, static_cast<double>(rss_dbm) - kUnheardDbm); }

/// Calls both(a, b) for shared access points and one(entry) for those of one fingerprint only.
template <class Both, class One>
void walk_union(const Fingerprint& a, const Fingerprint& b, Both&& both, One&& one) {
  auto i = a.entries.begin();
  auto j = b.entries.begin();
  while (i != a.entries.end() && j != b.entries.end()) {
    if (i->access_point < j->access_point) {
      one(*i++);
    } else if (j->access_point < i->access_point) {
      one(*j++);
    } else {
      both(*i++, *j++);
    }
  }
  while (i != a.entries.end()) one(*i++);
  while (j != b.entries.end()) one(*j++);
}

double cosine(const Fingerprint& a, const Fingerprint& b) {
  double dot = 0, squares_a = 0, squares_b = 0;
  for (const auto& entry : a.entries) squares_a += shifted(entry.rss_dbm) * shifted(entry.rss_dbm);
  for (const auto& entry : b.entries) squares_b += shifted(entry.rss_dbm) * shifted(entry.rss_dbm);
  walk_union(
      a, b, [&](const auto& x, const auto& y) { dot += shifted(x.rss_dbm) * shifted(y.rss_dbm); },
      [](const auto&) {});
  return dot > 0 ? std::min(1.0, dot / std::sqrt(squares_a * squares_b)) : 0;
}

/// The fingerprint with g = (RSS + 100)^e in place of the RSS.
Fingerprint powed(Fingerprint fingerprint, double exponent) {
  for (auto& entry : fingerprint.entries)
    entry.rss_dbm = static_cast<float>(std::pow(shifted(entry.rss_dbm), exponent));
  return fingerprint;
}

double sorensen_of_powed(const Fingerprint& a, const Fingerprint& b) {
  double shared = 0, sum = 0;
  walk_union(
      a, b,
      [&](const auto& x, const auto& y) {
        shared += static_cast<double>(std::min(x.rss_dbm, y.rss_dbm));
        sum += static_cast<double>(x.rss_dbm) + static_cast<double>(y.rss_dbm);
      },
      [&](const auto& x) { sum += static_cast<double>(x.rss_dbm); });
  return sum > 0 ? 2 * shared / sum : 0;
}

/// Sums from which all measures with a Gaussian follow.
struct GaussianSums {
  int shared = 0;          ///< H
  int alone = 0;           ///< M_i + M_j
  double squares_db2 = 0;  ///< sum of df^2 over the shared ones
  double detection2 = 0;   ///< sum of tau^2 over the others
};

GaussianSums gaussian_sums(const Fingerprint& a, const Fingerprint& b) {
  GaussianSums sums;
  walk_union(
      a, b,
      [&](const auto& x, const auto& y) {
        const double d = static_cast<double>(x.rss_dbm) - static_cast<double>(y.rss_dbm);
        ++sums.shared;
        sums.squares_db2 += d * d;
      },
      [&](const auto& x) {
        ++sums.alone;
        sums.detection2 += static_cast<double>(x.detection_rate) * static_cast<double>(x.detection_rate);
      });
  return sums;
}

double gaussian_family(const GaussianSums& sums, SimilarityMeasure measure, const SimilarityParams& params) {
  if (sums.shared == 0) return 0;
  const double exponent = -sums.squares_db2 / (2 * params.sigma_rss_db * params.sigma_rss_db);
  const double root = std::exp(exponent / sums.shared);
  const double overlap = static_cast<double>(sums.shared) / (sums.shared + sums.alone);
  switch (measure) {
    case SimilarityMeasure::kGaussian:
      return root * overlap;
    case SimilarityMeasure::kDetection:
      return root * overlap *
             std::exp(-sums.detection2 / (2 * params.sigma_detection * params.sigma_detection));
    case SimilarityMeasure::kSlide:
      return std::exp(exponent) / (sums.shared + sums.alone);
    case SimilarityMeasure::kMended:
      return sums.shared >= params.minimum_shared ? root : 0;
    case SimilarityMeasure::kCosine:
    case SimilarityMeasure::kSorensen:
      break;
  }
  return 0;
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
  if (measure == SimilarityMeasure::kCosine) return cosine(a, b);
  if (measure == SimilarityMeasure::kSorensen)
    return sorensen_of_powed(powed(a, params.sorensen_exponent), powed(b, params.sorensen_exponent));
  return gaussian_family(gaussian_sums(a, b), measure, params);
}

std::vector<std::vector<float>> similarity_table(const std::vector<Fingerprint>& a,
                                                 const std::vector<Fingerprint>& b, SimilarityMeasure measure,
                                                 const SimilarityParams& params) {
  const bool is_sorensen = measure == SimilarityMeasure::kSorensen;
  std::vector<Fingerprint> powed_a, powed_b;  // powers are taken once, not once per pair
  for (const auto& f : a) powed_a.push_back(is_sorensen ? powed(f, params.sorensen_exponent) : Fingerprint{});
  for (const auto& f : b) powed_b.push_back(is_sorensen ? powed(f, params.sorensen_exponent) : Fingerprint{});

  std::vector<std::vector<float>> table(a.size(), std::vector<float>(b.size()));
  parallel_for(a.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = 0; j < b.size(); ++j)
        table[i][j] = static_cast<float>(is_sorensen ? sorensen_of_powed(powed_a[i], powed_b[j])
                                                     : similarity(a[i], b[j], measure, params));
  });
  return table;
}

}  // namespace radioslam
