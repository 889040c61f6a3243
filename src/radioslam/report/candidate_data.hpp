// The pairs of keyframes that the overlap search kept, as a picture per pair of robots: a matrix of bins of
// keyframes, robot i across and robot j up, each bin with how many of its pairs were kept. A bin is a stretch
// of keyframes, so that a million pairs make a page as small as a thousand do, and every one is counted.
#pragma once

#include "radioslam/report/page_data.hpp"

namespace radioslam {

/// {"kept", "pairs", "distances_evaluated", "robot_pairs", "matrices": [{"robot_i", "robot_j", "kept",
///   "bins_i", "bins_j", "cell": [...], "count": [...]}]}, robot_i listed before robot_j. The fullest
/// matrices only, the fullest first; "robot_pairs" counts the pairs of robots with any pair of keyframes.
/// cell = bin_j * bins_i + bin_i, increasing; keyframe k of n is in bin floor(k bins / n). "pairs" and
/// "distances_evaluated" are null where the run did not search.
PageData candidate_data(const RunResult& result, const ReportParams& params);

}  // namespace radioslam
