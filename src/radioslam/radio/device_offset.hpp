// By how many dB each robot's device hears everything stronger than the team does: phones differ by several.
//
// No place is needed. Of fingerprints i, j of robots a, b, the access points both hear differ by
//   d_k = f_ik - f_jk = o_a - o_b + what their places, shadows and fading differ by,
// whose spread does not see the offset. So pairs of one place are found by the Gaussian measure with the
// pair's own mean difference taken off,
//   s_ij = exp(-var(d) / 2 sigma_r^2) H / (H + M_i + M_j),
// and those that prefer each other are asked, where two robots have a few such. What one says is the mean of
// d over a few access points that no scan of the two missed, the strongest: of weak ones only the lucky
// readings are heard, which hides an offset. The offsets o minimise
//   sum over pairs of Huber((d_ij - o_a + o_b) / s) + sum over robots of o^2 / 2 sigma_o^2,
// s from the median residual, so they sum to zero over robots that are tied, and are zero for one that is
// not. A fingerprint in m pairs errs in all of them: covariances grow by (1 + m) / 2. All offsets are kept,
// or none when chi-squared finds none beyond false alarm; adding c dB to a robot's readings moves its offset
// against every other one by c (less what the prior holds back). Of large offsets a tenth or two goes unseen,
// since a device that hears less hears fewer access points. Never refuses: no scans, one robot, or nothing in
// common give zeros. dB. Cost: the shared access points of all pairs of fingerprints of different robots, on
// all threads.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"

namespace radioslam {

struct DeviceOffsetParams {
  double prior_sigma_db = 3;
  double least_sigma_db = 0.3;
  double false_alarm_probability = 0.0027;
  int strongest_shared = 7;
  double least_similarity = 0.4;
  int least_pairs = 8;
  int most_iterations = 30;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"device_offset_sigma_db", "dB", 0, 100,
                "how much stronger one robot's device may hear than another's; 0: none is estimated. Phones "
                "differ by 2-6"},
          self.prior_sigma_db);
    visit(Field{"device_offset_least_sigma_db", "dB", 0, 100,
                "an offset is never known better: what bodies and mountings change on the way"},
          self.least_sigma_db);
    visit(Field{"device_offset_false_alarm", "", 1e-9, 0.5,
                "probability of taking off offsets where there are none; three sigma"},
          self.false_alarm_probability);
    visit(Field{"device_offset_strongest", "", 1, 1000,
                "a pair of fingerprints tells its offset by so many access points; weaker ones hide it"},
          self.strongest_shared);
    visit(Field{"device_offset_least_similarity", "", 0, 1,
                "of a pair that tells; below, real places differ by more than phones"},
          self.least_similarity);
    visit(Field{"device_offset_least_pairs", "", 2, 1e6,
                "of two robots that tell; fewer may all be from one odd place"},
          self.least_pairs);
    visit(Field{"device_offset_iterations", "", 1, 1000, "of offsets and weights in turn"},
          self.most_iterations);
  }
};

enum class DeviceOffsetStatus {
  kNotSought,    ///< switched off, no fingerprints, or nobody else's
  kNotObserved,  ///< fewer than least_pairs pairs with every other robot
  kNotShown,     ///< told, and the team's offsets are no larger than their errors
  kTakenOff,
};

/// How much stronger than the team's mean a robot's device hears.
struct DeviceOffset {
  double offset_db = 0;
  double sigma_db = 0;    ///< of the estimate, whether kept or not; the prior's when nothing tells
  std::size_t pairs = 0;  ///< of fingerprints that told of it
  DeviceOffsetStatus status = DeviceOffsetStatus::kNotSought;
};

struct DeviceOffsets {
  std::vector<DeviceOffset> robots;  ///< all zero unless they show
  bool shown = false;
};

/// `robots` holds the fingerprints of each; of `similarity`, sigma_rss_db and minimum_shared are used.
DeviceOffsets estimate_device_offsets(const std::vector<std::vector<Fingerprint>>& robots,
                                      const SimilarityParams& similarity, const DeviceOffsetParams& params);

/// The fingerprints as the team's mean device would have heard them.
void remove_device_offset(std::vector<Fingerprint>& fingerprints, double offset_db);

}  // namespace radioslam
