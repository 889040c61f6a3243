// Table of place recognition with and without radio next to published results: the pairs of keyframes from
// all of them over those that are kept, compared, registered and verified to the accepted closures, then
// error and seconds. Columns: the thesis without and with Wi-Closure, then no radio, no pruning, pruning.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/study/study_table.hpp"
#include "radioslam/study/wi_closure/place_study.hpp"

namespace radioslam {

inline std::string not_published() { return number_text(std::nullopt, 0); }

/// Published cells of a row: the baseline's, and those with Wi-Closure.
struct PublishedCells {
  std::string baseline = not_published(), pruned = not_published();
};

/// The cells of the rows that have published figures; of the search, those with Wi-Closure.
struct PublishedPlaces {
  std::string pairs, kept, true_kept, recall, false_rejected, search_s;
  PublishedCells true_pairs, ate_m, total_s;
  /// Settings that the thesis did not run here.
  std::optional<PlaceSettings> without = {};
};

/// Everything in the table that is not measured here.
struct PlaceTableText {
  std::string title;
  std::string scene;    ///< the lead without its seeds
  std::string scans_s;  ///< label of the row of PlaceRun::scans_s
  PublishedPlaces published;
  std::vector<std::string> notes;  ///< followed by those that hold for every such table, with mark [2]
};

/// Medians over at least one seed; all seeds have the same settings. Rows that depend on the parameters of
/// place recognition begin with their name (word_for).
StudyTable place_table(const std::vector<PlaceStudy>& seeds, PlaceTableText text);

}  // namespace radioslam
