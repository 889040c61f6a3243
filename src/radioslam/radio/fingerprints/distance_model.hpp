// Distance model: predicts the distance of two fingerprints and its spread from their similarity, trained on
// the mission's own odometry. Source: Liu et al. (2020), eq. 5: mean and variance of the odometry distance
// over pairs of one robot whose similarity is within half a bin of s; odometry is trusted over a limited path
// length. Along a path small distances are common and large ones rare; between robots in the plane it is the
// reverse. Samples are therefore weighted by the inverse frequency of their distance, so that a window's mean
// is that of p(s | d) as a function of d, without a prior on d.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

struct DistanceModelParams {
  double bin_width = 0.05;  ///< r
  int min_samples = 30;
  double max_trusted_path_m = 100;
  bool even_distances = true;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(bin_width, "", 0.001, 1,
                    "width r of the similarity window over which distances are averaged (Liu et al. 2020)");
    RADIOSLAM_FIELD(min_samples, "", 2, 1e6,
                    "smallest number of training samples in a similarity window that predicts a distance");
    RADIOSLAM_BASIC_FIELD(
        max_trusted_path_m, "m", 1, 1e6,
        "largest path length between fingerprints whose odometry distance trains the model");
    RADIOSLAM_FIELD(even_distances, "", 0, 1,
                    "weighting of training samples so that all distances are equally common");
  }
};

/// Similarity and odometry distance of two fingerprints of one robot.
struct DistanceSample {
  double similarity = 0;
  double distance_m = 0;
};

/// Predicted distance: mean and standard deviation, and the Gaussian exp(-(d - peak)^2 / 2 spread^2)
/// truncated to d >= 0 that has both, as used by a range factor. For close pairs the peak is 0.
struct PredictedDistance {
  double mean_m = 0;
  double sigma_m = 0;
  int samples = 0;
  double peak_m = 0;
  double spread_m = 0;
};

/// Fits the truncated Gaussian with this mean and standard deviation; its peak is at least zero.
PredictedDistance truncated_at_zero(double mean_m, double sigma_m, int samples);

/// d(s) and sigma(s) over a window that slides over s in steps of a hundredth of its width.
class DistanceModel {
 public:
  DistanceModel(std::vector<DistanceSample> samples, const DistanceModelParams& params);

  /// Prediction at the step nearest to `similarity`; nothing where it is negative or its window has too few
  /// samples.
  std::optional<PredictedDistance> predict(double similarity) const;
  /// Smallest mean distance predicted for any similarity; nothing where none is clearly below the mean
  /// distance of all samples.
  std::optional<double> smallest_distance_m() const;
  /// Smallest similarity whose predicted mean is below `distance_m`; nothing where there is none.
  std::optional<double> min_similarity_below(double distance_m) const;
  const std::vector<DistanceSample>& samples() const { return samples_; }

 private:
  std::optional<PredictedDistance> predict_from_window(double similarity) const;

  DistanceModelParams params_;
  std::vector<DistanceSample> samples_;                  ///< sorted by similarity
  std::vector<double> weight_, sum_, sum_of_squares_;    ///< prefix sums over the samples, starting with 0
  std::vector<std::optional<PredictedDistance>> steps_;  ///< predictions for similarities from 0 to 1
};

// Exponential decay of similarity with distance, d = -L ln s, with one decay length for the whole mission.
// Sørensen similarity follows this law from a few metres to several times L, far beyond the distances for
// which a short path can train DistanceModel, so it can place robots whose starts are unknown.

/// d = -length_m ln s.
struct DecayModel {
  double length_m = 0;

  /// Distance at similarity `s` in (0, 1]; at least `kNearest_m`, below which similarity is uninformative.
  double distance_m(double s) const;

  static constexpr double kNearest_m = 1;
};

/// Decay length as the median of d / -ln s over samples of informative similarity (0.02 to 0.9) whose
/// positions are at least 2 m apart; nothing with fewer than `min_samples` of them.
std::optional<DecayModel> fit_decay(const std::vector<DistanceSample>& samples, int min_samples);

/// Median distance by similarity over any range of distances: of samples in bins of equally many, never
/// rising with similarity (bins that would are pooled), linear between bins and constant beyond them. Places
/// robots whose starts are unknown, where far pairs count as well as near ones.
class MedianModel {
 public:
  /// Nothing with fewer than `min_samples` samples.
  static std::optional<MedianModel> fit(std::vector<DistanceSample> samples, int min_samples);
  double distance_m(double similarity) const;

 private:
  std::vector<double> similarities_, distances_m_;  ///< of the bins, similarities rising
};

}  // namespace radioslam
