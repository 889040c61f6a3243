// Published results of Wi-Closure (Wang et al.), table II and section V-B: a hall of 25 x 23 m with identical
// pillars, two robots with a VLP-16 cut to 10 m. Contradictions are noted in hall_tables.cpp.
#pragma once

namespace radioslam::published_wi_closure_hall {

/// 42 x 44: most likely the pairs of keyframes.
inline constexpr double kPairs = 1848;
inline constexpr double kKept = 119;
inline constexpr double kTrueKept = 115;
inline constexpr double kRecall = 0.85;          ///< "missed true LC 15 %"
inline constexpr double kFalseRejected = 0.787;  ///< "correctly rejected false LC"
inline constexpr double kBaselineAte_m = 17.6, kAte_m = 1.9;
inline constexpr double kBaseline_s = 155, kWithSearch_s = 36;
inline constexpr double kSearch_s = 0.5;
/// Of all angle measurements; all direct paths were found.
inline constexpr int kAngles = 4, kDirectPaths = 3, kFalsePaths = 17;

}  // namespace radioslam::published_wi_closure_hall
