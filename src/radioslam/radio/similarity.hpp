// How alike two fingerprints are, 0 (nothing in common) to 1 (the same).
// H access points are heard in both, M_i and M_j in one only; f is the mean RSS, tau the detection rate.
// Sources: Liu et al. (cosine, Gaussian, Gaussian with detection likelihood, eq. 2-4); Dammalapati and
// Hajdarpasic, WiFi Assisted Loop Closure Detection (slide, mended); Sørensen on powed RSS as in
// Torres-Sospedra et al. 2015. Two fingerprints without a shared access point have similarity 0.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/fingerprint.hpp"

namespace radioslam {

enum class SimilarityMeasure {
  kCosine,     ///< over the union, RSS shifted by +100 dB, absent = 0
  kGaussian,   ///< (prod exp(-df^2 / 2 sigma_r^2))^(1/H) * H / (H + M_i + M_j)
  kDetection,  ///< the same times prod over the other access points of exp(-tau^2 / 2 sigma_tau^2)
  kSlide,      ///< prod exp(-df^2 / 2 sigma_r^2) / (L_i + L_j - H): shrinks with H; for comparison
  kMended,     ///< (prod exp(-df^2 / 2 sigma_r^2))^(1/H), 0 below `minimum_shared`
  kSorensen,   ///< 2 sum min(g_i, g_j) / sum (g_i + g_j), g = (RSS + 100)^e
};
std::string_view to_string(SimilarityMeasure measure);
std::optional<SimilarityMeasure> similarity_measure(std::string_view name);

struct SimilarityParams {
  double sigma_rss_db = 6;     ///< sigma_r
  double sigma_detection = 4;  ///< sigma_tau
  double sorensen_exponent = 2.718281828459045;
  int minimum_shared = 5;  ///< mended measure: fewer shared access points are no evidence

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"sigma_rss_db", "dB", 0.1, 100, "spread of RSS at one place; Liu et al., 36 dB^2"},
          self.sigma_rss_db);
    visit(Field{"sigma_detection", "", 0.01, 1000, "how mildly extra access points count; Liu et al. best"},
          self.sigma_detection);
    visit(Field{"sorensen_exponent", "", 0.1, 10, "power of the shifted RSS; Torres-Sospedra et al., e"},
          self.sorensen_exponent);
    visit(Field{"minimum_shared", "", 1, 1000, "mended measure: least number of shared access points"},
          self.minimum_shared);
  }
};

/// Similarity of two fingerprints; linear in their entries.
double similarity(const Fingerprint& a, const Fingerprint& b, SimilarityMeasure measure,
                  const SimilarityParams& params);

/// Similarity of every pair, a.size() rows by b.size() columns, on all threads.
std::vector<std::vector<float>> similarity_table(const std::vector<Fingerprint>& a,
                                                 const std::vector<Fingerprint>& b, SimilarityMeasure measure,
                                                 const SimilarityParams& params);

}  // namespace radioslam
