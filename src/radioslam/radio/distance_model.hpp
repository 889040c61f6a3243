// What a similarity says about distance, learned from a mission's own odometry.
// Source: Liu et al., eq. 5: mean and variance of the odometry distance of pairs of one robot whose
// similarity lies within half a bin of s; odometry is trusted over a short way.
// Along a way near pairs are common and far ones rare; two robots meet in the plane, where it is the other
// way round. Samples are therefore weighed by one over how common their distance is, so that the window's
// mean is that of p(s | d) as a function of d and carries no prior of its own.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

struct DistanceModelParams {
  double bin_width = 0.05;     ///< r
  int minimum_samples = 30;    ///< a window with fewer predicts nothing
  double trusted_way_m = 100;  ///< pairs further apart along the way do not train
  bool even_distances = true;  ///< weigh samples so that every distance is as common as any other

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"bin_width", "", 0.001, 1, "window over similarity; Liu et al."}, self.bin_width);
    visit(Field{"minimum_samples", "", 2, 1e6, "fewer samples in a window predict nothing"},
          self.minimum_samples);
    visit(
        Field{"trusted_way_m", "m", 1, 1e6, "way over which odometry distances train the model; Liu et al."},
        self.trusted_way_m);
    visit(Field{"even_distances", "", 0, 1, "weigh samples so that every distance is equally common"},
          self.even_distances);
  }
};

/// One pair of fingerprints of one robot.
struct DistanceSample {
  double similarity = 0;
  double distance_m = 0;
};

/// The distance that a similarity stands for: its moments, and the Gaussian exp(-(d - peak)^2 / 2 spread^2)
/// over d >= 0 that has these moments, which is what a range factor adds to a likelihood. For near pairs the
/// peak is 0: they may be anywhere around, most likely together.
struct PredictedDistance {
  double mean_m = 0;
  double sigma_m = 0;
  int samples = 0;
  double peak_m = 0;
  double spread_m = 0;
};

/// Peak and spread of the Gaussian that, cut off below zero, has this mean and standard deviation; the peak
/// is not allowed below zero.
PredictedDistance cut_off_at_zero(double mean_m, double sigma_m, int samples);

/// d(s) and sigma(s) by a window sliding over s in steps of a hundredth of its width.
class DistanceModel {
 public:
  DistanceModel(std::vector<DistanceSample> samples, const DistanceModelParams& params);

  /// Nothing where too few samples lie within half a bin of `similarity`, taken to the nearest step, or it
  /// is negative.
  std::optional<PredictedDistance> predict(double similarity) const;
  /// The smallest mean distance that any similarity predicts; nothing where none predicts clearly less than
  /// what pairs of any similarity are apart.
  std::optional<double> smallest_distance_m() const;
  /// The least similarity that predicts a mean below `distance_m`; nothing where none does.
  std::optional<double> least_similarity_below(double distance_m) const;
  const std::vector<DistanceSample>& samples() const { return samples_; }

 private:
  std::optional<PredictedDistance> predict_from_window(double similarity) const;

  DistanceModelParams params_;
  std::vector<DistanceSample> samples_;                  ///< by similarity
  std::vector<double> weight_, sum_, sum_of_squares_;    ///< running sums over the samples, one longer
  std::vector<std::optional<PredictedDistance>> steps_;  ///< of similarities from 0 to 1
};

}  // namespace radioslam
