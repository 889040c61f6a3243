// How far a run goes, and what it skips.
#pragma once

#include "radioslam/closure/overlap/overlap_search.hpp"
#include "radioslam/joint/matches/match_selection.hpp"

namespace radioslam {

struct RunOptions {
  Pruning pruning = Pruning::kOn;
  SearchMethod search = SearchMethod::kTree;
  bool overlap_only = false;  ///< stop after the overlap search
  /// Receives every candidate as the search finds it; then none is listed in the result.
  TakeCandidates take_candidates = nullptr;
};

}  // namespace radioslam
