// Were the pairs that were kept true ones? Precision = true_kept / kept, recall = true_kept / true_pairs.
// A pair of keyframes of two robots is true when the true positions at the two stamps are closer than the
// sum of the two robots' reaches. The truth between two of its poses is taken linearly; a keyframe that the
// truth does not cover cannot be judged, nor can a pair with such a keyframe.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// What was searched, what of it was true, and what was kept. Only pairs that can be judged count.
struct PairCounts {
  std::size_t pairs = 0;
  std::size_t true_pairs = 0;
  std::size_t kept = 0;
  std::size_t true_kept = 0;
};

/// The stamps at which a robot's keyframes stand, in time order.
using KeyframeStamps = std::vector<Stamp>;

/// Truth, what it is compared with and how far "close" reaches; all in the order of Mission::robots.
struct PairTruth {
  const Truth& truth;
  int dimension = 2;            ///< 2 measures distances in the plane
  std::vector<double> reach_m;  ///< per robot; a pair's radius is the sum of its two robots'
};

/// Every robot's reach for one radius shared by all pairs.
std::vector<double> reach_for_radius(std::size_t robots, double radius_m);

/// Out of all pairs of keyframes of different robots, the candidates were kept.
PairCounts count_candidates(const std::vector<KeyframeStamps>& keyframes,
                            const std::vector<CandidateResult>& candidates, const PairTruth& truth);

/// Out of the closures between different robots, the accepted ones were kept.
PairCounts count_closures(const std::vector<ClosureResult>& closures, const PairTruth& truth);

}  // namespace radioslam
