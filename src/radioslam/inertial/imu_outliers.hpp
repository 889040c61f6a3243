// Removes single IMU outliers: samples that are physically impossible or far from their neighbours.
//
//   outlier:  not finite, or beyond `max_force_mps2` or `max_rate_radps`
//             |x - m| > max_jump + max_jump_mads * median |x_k - m| in any component, where m is the median
//             over the sample and three neighbours on either side
// A real impact lasts longer than one sample. If more than `max_outlier_ratio` were outliers, the data as a
// whole is suspicious: all samples are kept and later tests decide (imu_consistency.hpp).
// Cost: linear in the samples.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct ImuOutlierParams {
  double max_force_mps2 = 2000;
  double max_rate_radps = 200;
  double max_jump_mps2 = 30;
  double max_jump_radps = 5;
  double max_jump_mads = 10;
  double max_outlier_ratio = 0.05;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(max_force_mps2, "m/s^2", 20, 1e6,
                    "largest specific force that an IMU measures; the default is about 200 g");
    RADIOSLAM_FIELD(max_rate_radps, "rad/s", 1, 1e5, "largest angular rate that an IMU measures");
    RADIOSLAM_FIELD(max_jump_mps2, "m/s^2", 0, 1e6,
                    "largest plausible difference of a specific force from its neighbours' median");
    RADIOSLAM_FIELD(max_jump_radps, "rad/s", 0, 1e5,
                    "largest plausible difference of an angular rate from its neighbours' median");
    RADIOSLAM_FIELD(
        max_jump_mads, "", 0, 1e6,
        "median absolute deviations of the neighbours that are added to the largest plausible differences");
    RADIOSLAM_FIELD(max_outlier_ratio, "", 0, 1,
                    "largest fraction of samples removed as outliers; with more, all samples are kept");
  }
};

struct FilteredImu {
  std::vector<ImuSample> samples;
  std::size_t removed = 0;
};

/// The same sample by sample; a sample is judged once three more have come.
class ImuOutlierFilter {
 public:
  explicit ImuOutlierFilter(const ImuOutlierParams& params) : params_(params) {}

  /// Takes the next sample and appends to `kept` what has been judged by now.
  void add(const ImuSample& sample, std::vector<ImuSample>& kept);
  /// Judges the rest.
  void finish(std::vector<ImuSample>& kept);

  std::size_t removed() const { return removed_; }
  /// Whether so much would be removed that the data as a whole is suspicious; nothing is from then on.
  bool is_suspicious() const;

 private:
  void judge(std::vector<ImuSample>& kept);

  ImuOutlierParams params_;
  std::vector<ImuSample> window_;  ///< possible samples about the one that is judged next
  std::size_t next_ = 0;           ///< of the window
  std::size_t seen_ = 0, removed_ = 0;
};

FilteredImu remove_imu_outliers(const std::vector<ImuSample>& samples, const ImuOutlierParams& params);

}  // namespace radioslam
