// Precision and recall of candidates and closures: precision = true_kept / kept, recall = true_kept /
// true_pairs. A pair of keyframes of two robots is true if its true positions are closer than the sum of the
// two robots' ranges, or, with min_shared_view, if the views share that much at its true poses
// (closure/overlap/overlap_view.hpp). Truth is interpolated linearly between its poses; keyframes outside the
// truth, and pairs with such keyframes, are not evaluated.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"
#include "radioslam/closure/overlap/overlap_view.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Numbers of pairs searched, true and kept; only pairs covered by the truth count.
struct PairCounts {
  std::size_t pairs = 0;
  std::size_t true_pairs = 0;
  std::size_t kept = 0;
  std::size_t true_kept = 0;
};

/// Stamps of a robot's keyframes, in time order.
using KeyframeStamps = std::vector<Stamp>;

/// Truth and the criterion for true pairs; robots in the order of Mission::robots.
struct PairTruth {
  const Truth& truth;
  int dimension = 2;                 ///< 2: horizontal distances
  std::vector<OverlapSensor> views;  ///< per robot; all round where the truth has no orientations
  /// Smallest intersection over union of a true pair's views; 0: the pair is closer than the sum of the
  /// ranges, whatever its headings.
  double min_shared_view = 0;
};

/// The LiDARs' views.
std::vector<OverlapSensor> lidar_views(const Mission& mission);

/// Views that give every pair the same radius, with min_shared_view 0.
std::vector<OverlapSensor> reach_for_radius(std::size_t robots, double radius_m);

/// By this radius or, without one, by what the LiDARs' views share.
PairTruth pair_truth(const Mission& mission, const Truth& truth, std::optional<double> radius_m,
                     double min_shared_view);

/// Counts over all pairs of keyframes of different robots; `candidates` are the pairs kept.
PairCounts count_candidates(const std::vector<KeyframeStamps>& keyframes, const CandidateList& candidates,
                            const PairTruth& truth);

/// Counts over all closures between different robots; the accepted ones are the pairs kept.
PairCounts count_closures(const std::vector<ClosureResult>& closures, const PairTruth& truth);

}  // namespace radioslam
