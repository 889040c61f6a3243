// Similarity measures of two fingerprints, from 0 (no shared access point) to 1 (identical).
// H access points are detected in both, M_i and M_j in one only, L_i = H + M_i; f is the mean RSS, tau the
// detection rate. Sources: Liu et al. (2020), eq. 2-4 (cosine, Gaussian, Gaussian with detection likelihood);
// Dammalapati and Hajdarpasic, WiFi Assisted Loop Closure Detection (slide, mended); Torres-Sospedra et al.
// (2015) for Sørensen on powed RSS.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"

namespace radioslam {

enum class SimilarityMeasure {
  kCosine,         ///< over the union, RSS shifted by +100 dB, undetected = 0
  kGaussian,       ///< (prod exp(-df^2 / 2 sigma_r^2))^(1/H) * H / (H + M_i + M_j)
  kDetection,      ///< kGaussian times prod over unshared access points of exp(-tau^2 / 2 sigma_tau^2)
  kProduct,        ///< prod exp(-df^2 / 2 sigma_r^2) / (L_i + L_j - H): shrinks with H; for comparison
  kGeometricMean,  ///< (prod exp(-df^2 / 2 sigma_r^2))^(1/H), 0 below `min_shared`
  kSorensen,       ///< 2 sum min(g_i, g_j) / sum (g_i + g_j), g = (RSS + 100)^e
};
std::string_view to_string(SimilarityMeasure measure);
std::optional<SimilarityMeasure> similarity_measure(std::string_view name);

struct SimilarityParams {
  double sigma_rss_db = 6;     ///< sigma_r
  double sigma_detection = 4;  ///< sigma_tau
  double sorensen_exponent = 2.718281828459045;
  int min_shared = 5;  ///< of kGeometricMean

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(sigma_rss_db, "dB", 0.1, 100,
                          "standard deviation of RSS at one position; 6 dB in Liu et al. (2020)");
    RADIOSLAM_FIELD(
        sigma_detection, "", 0.01, 1000,
        "tolerance of the detection measure to unshared access points; higher values penalise them less");
    RADIOSLAM_FIELD(
        sorensen_exponent, "", 0.1, 10,
        "exponent of the shifted RSS in the sorensen measure; e in Torres-Sospedra et al. (2015)");
    RADIOSLAM_FIELD(min_shared, "", 1, 1000, "smallest number of shared access points in the mended measure");
  }
};

/// Similarity of two fingerprints; linear in their entries.
double similarity(const Fingerprint& a, const Fingerprint& b, SimilarityMeasure measure,
                  const SimilarityParams& params);

/// Similarity of every pair, a.size() rows by b.size() columns; uses all threads.
std::vector<std::vector<float>> similarity_table(const std::vector<Fingerprint>& a,
                                                 const std::vector<Fingerprint>& b, SimilarityMeasure measure,
                                                 const SimilarityParams& params);

}  // namespace radioslam
