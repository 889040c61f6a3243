// Published results of Wi-Closure (Wang et al.), table I and section V-A: KITTI 08, pairs within 35 m are
// true. Contradictions within the publication are noted in wi_closure_kitti.cpp.
#pragma once

namespace radioslam::published_wi_closure {

inline constexpr double kPairs = 1099101;
inline constexpr double kTruePairs = 5544;
inline constexpr double kKept = 7049;
inline constexpr double kTrueKept = 3631;
inline constexpr double kRecall = kTrueKept / kTruePairs;
inline constexpr double kFalseRejected = 1 - (kKept - kTrueKept) / (kPairs - kTruePairs);
inline constexpr double kSearch_s = 53;
inline constexpr double kBaseline_s = 896, kWithSearch_s = 464;
inline constexpr double kBaselineAte_m = 66.1;

}  // namespace radioslam::published_wi_closure
